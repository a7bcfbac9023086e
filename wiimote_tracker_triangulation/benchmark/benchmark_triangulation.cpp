// Accuracy and time of triangulation, ours and OpenCV's, in one table: RMS over the
// Cramer-Rao bound, normalised error squared (3 when the covariance is consistent), time per point.
#include "benchmark_program.h"
#include "geometry/random_rigs.h"
#include "wiimote_tracker_triangulation/geometry/triangulate.h"

#include <wiimote_tracker_msgs/median.h>

#include <Eigen/LU>
#ifdef WIIMOTE_TRACKER_HAVE_OPENCV
#include <opencv2/calib3d.hpp>
#endif

#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

using namespace wiimote_tracker;

namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using geometry::Camera;

constexpr double kPixelStddev = 0.5;  // of each pixel coordinate [px]
constexpr int kTimedPoints = 1000;
constexpr int kRepetitions = 21;  // of each method, taken in turn against drift

/// A cube, and cameras a quarter turn apart about it, which see its middle.
struct Layout {
  const char* name;
  double distance;  // of the cameras from the cube's axis [m]
  double height;    // above its middle [m]
  double side;      // [m]
};

/// The paper's Fig. 1: cameras 4.5 m outside the cube's vertical edges, 2 m high. Then a ring: the
/// ranges differ more, and the cameras lie nearer.
constexpr Layout kLayouts[] = {{"paper", 1.25 * M_SQRT2 + 4.5, 0.75, 2.5}, {"ring", 4.1, 1.0, 1.5}};

/// Points seen by all of some cameras, which have no distortion; noise is Gaussian. Simulated
/// without any measured code. With all that the methods start from.
struct Scene {
  std::string name;
  std::vector<Camera> cameras;
  std::vector<Vector3d> truth;                                   // world [m]
  std::vector<std::vector<geometry::Observation>> observations;  // of each point, one a camera
  std::vector<geometry::Sight> sights;                           // the same, in one row
  double bound = 0.0;  // Cramer-Rao bound on the RMS distance of unbiased estimates [m]
};

Vector2d pixelOf(const Camera& camera, const Vector3d& point) {
  const Vector3d seen = camera.world_from_camera.linear().transpose() *
                        (point - camera.world_from_camera.translation());
  return {camera.intrinsics.fx * seen.x() / seen.z() + camera.intrinsics.cx,
          camera.intrinsics.fy * seen.y() / seen.z() + camera.intrinsics.cy};
}

/// Trace of the inverse Fisher information, by numerical derivatives [m^2].
double squaredBoundAt(const std::vector<Camera>& cameras, const Vector3d& point) {
  constexpr double kStep = 1e-4;  // [m]
  Matrix3d information = Matrix3d::Zero();
  for (const Camera& camera : cameras) {
    Eigen::Matrix<double, 2, 3> slope;
    for (int a = 0; a < 3; ++a) {
      const Vector3d step = kStep * Vector3d::Unit(a);
      slope.col(a) =
          (pixelOf(camera, point + step) - pixelOf(camera, point - step)) / (2.0 * kStep);
    }
    information += slope.transpose() * slope;
  }
  return information.inverse().trace() * kPixelStddev * kPixelStddev;
}

/// @param scene without its points; it must stay where it is, since observations refer to it.
void makeScene(const Layout& layout, int cameras, int points, unsigned seed, Scene* scene) {
  geometry::test::Random random(seed);
  scene->name = std::string(layout.name) + " " + std::to_string(cameras);
  for (int i = 0; i < cameras; ++i) {
    const double angle = M_PI / 4.0 + i * M_PI / 2.0;
    Camera& camera = scene->cameras.emplace_back();
    camera.name = "camera_" + std::to_string(i + 1);
    camera.world_from_camera = geometry::lookAt(
        {layout.distance * std::cos(angle), layout.distance * std::sin(angle), layout.height},
        Vector3d::Zero(), Vector3d::UnitZ());
  }
  double squared_bound = 0.0;
  for (int i = 0; i < points; ++i) {
    const Vector3d truth = random.inBox(0.5 * layout.side);
    scene->truth.push_back(truth);
    scene->observations.emplace_back();
    for (const Camera& camera : scene->cameras) {
      const double noise_u = random.gaussian();
      const double noise_v = random.gaussian();
      const Vector2d pixel = pixelOf(camera, truth) + kPixelStddev * Vector2d(noise_u, noise_v);
      scene->observations.back().push_back({&camera, pixel});
      scene->sights.push_back(*geometry::sightFromPixel(camera, pixel));
    }
    squared_bound += squaredBoundAt(scene->cameras, truth);
  }
  scene->bound = std::sqrt(squared_bound / points);
}

/// A method's result for a point; NaN where it has none.
struct Estimate {
  Vector3d position = Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  Matrix3d covariance = Matrix3d::Constant(std::numeric_limits<double>::quiet_NaN());
};

/// Estimates the first points of a scene, as many as there are.
using Run = std::function<void(std::vector<Estimate>* estimates)>;

/// @param triangulate from the point's number. Memory is allocated before the timing.
template <typename Triangulate>
Run eachBy(const Triangulate& triangulate) {
  return [triangulate](std::vector<Estimate>* estimates) {
    for (std::size_t i = 0; i < estimates->size(); ++i) {
      if (const std::optional<geometry::TriangulatedPoint> point = triangulate(i))
        (*estimates)[i] = {point->position, point->covariance};
    }
  };
}

#ifdef WIIMOTE_TRACKER_HAVE_OPENCV
/// As its users call it: all points at once.
Run opencv(const Scene& scene) {
  const int count = static_cast<int>(scene.truth.size());
  std::vector<cv::Mat_<double>> P, pixels;
  for (std::size_t c = 0; c < 2; ++c) {
    const Camera& camera = scene.cameras[c];
    Matrix3d K;
    K << camera.intrinsics.fx, 0, camera.intrinsics.cx, 0, camera.intrinsics.fy,
        camera.intrinsics.cy, 0, 0, 1;
    Eigen::Matrix<double, 3, 4, Eigen::RowMajor> projection =
        K * camera.world_from_camera.inverse(Eigen::Isometry).matrix().topRows<3>();
    P.push_back(cv::Mat_<double>(3, 4, projection.data()).clone());
    pixels.emplace_back(2, count);
    for (int i = 0; i < count; ++i) {
      for (int axis = 0; axis < 2; ++axis)
        pixels[c](axis, i) = scene.observations[static_cast<std::size_t>(i)][c].pixel[axis];
    }
  }
  return [P, pixels](std::vector<Estimate>* estimates) {
    const int n = static_cast<int>(estimates->size());
    cv::Mat_<double> h;
    cv::triangulatePoints(P[0], P[1], pixels[0].colRange(0, n), pixels[1].colRange(0, n), h);
    for (int i = 0; i < n; ++i)
      (*estimates)[static_cast<std::size_t>(i)].position =
          Vector3d(h(0, i), h(1, i), h(2, i)) / h(3, i);
  };
}
#endif

/// The ways to intersect a scene's rays, with their names. OpenCV's takes two cameras.
std::vector<std::pair<std::string, Run>> methodsFor(const Scene& scene) {
  using Way = geometry::TriangulationMethod;
  const auto options = [](Way way) { return geometry::TriangulationOptions{way, kPixelStddev}; };
  const auto fromSights = [&](Way way) {
    return eachBy([&scene, views = scene.cameras.size(), how = options(way)](std::size_t i) {
      return geometry::triangulate(&scene.sights[i * views], views, how);
    });
  };
  const auto fromPixels = [&scene, how = options(Way::kMaximumLikelihood)](std::size_t i) {
    return geometry::triangulate(scene.observations[i], how);  // includes undistortion
  };
  std::vector<std::pair<std::string, Run>> methods = {
      {"maximum likelihood", fromSights(Way::kMaximumLikelihood)},
      {"maximum likelihood, from pixels", eachBy(fromPixels)},
      {"reweighted midpoint", fromSights(Way::kReweightedMidpoint)},
      {"least squares", fromSights(Way::kLeastSquares)},
      {"mean of closest points (paper)", fromSights(Way::kMeanClosest)}};
#ifdef WIIMOTE_TRACKER_HAVE_OPENCV
  if (scene.cameras.size() == 2)
    methods.push_back({"OpenCV triangulatePoints", opencv(scene)});
#endif
  return methods;
}

BenchmarkRow accuracyOf(const Scene& scene, const std::string& method, const Run& run) {
  std::vector<Estimate> estimates(scene.truth.size());
  run(&estimates);
  double squared = 0.0;
  double nees = 0.0;
  for (std::size_t i = 0; i < scene.truth.size(); ++i) {
    const Vector3d error = estimates[i].position - scene.truth[i];
    squared += error.squaredNorm();
    nees += error.dot(estimates[i].covariance.inverse() * error);
  }
  const auto count = static_cast<double>(scene.truth.size());
  return {scene.name + " cameras, " + method,
          {{"bound [mm]", 1e3 * scene.bound},
           {"RMS / bound", std::sqrt(squared / count) / scene.bound},
           {"NEES", nees / count}}};
}

void measure(const Scene& scene, const RowCallback& row) {
  const auto methods = methodsFor(scene);
  std::vector<Estimate> estimates(kTimedPoints);
  std::vector<std::vector<double>> seconds(methods.size());
  for (int i = 0; i < kRepetitions; ++i) {
    for (std::size_t m = 0; m < methods.size(); ++m) {
      const auto begin = std::chrono::steady_clock::now();
      methods[m].second(&estimates);
      const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
      seconds[m].push_back(took.count());
    }
  }
  for (std::size_t m = 0; m < methods.size(); ++m) {
    BenchmarkRow result = accuracyOf(scene, methods[m].first, methods[m].second);
    result.figures.emplace_back("ns / point", 1e9 * medianOf(&seconds[m]) / kTimedPoints);
    row(result);
  }
}

void run(const BenchmarkSettings& settings, const RowCallback& row) {
  for (const Layout& layout : kLayouts) {
    for (const int cameras : {2, 4}) {
      Scene scene;
      makeScene(layout, cameras, kTimedPoints * settings.runs, settings.seed, &scene);
      measure(scene, row);
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  return runBenchmark(
      "benchmark_triangulation",
      {{"triangulation",
        "1000 points per --runs, 0.5 px of noise, lenses without distortion. Time: median of 21 "
        "runs over 1000 points, methods in turn, from rays that are ready unless it says from "
        "pixels. Only ours give a covariance. ring: cameras on a circle.",
        run}},
      argc, argv);
}
