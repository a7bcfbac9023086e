#include "triangulation_scene.h"

#include "wiimote_tracker_triangulation/geometry/triangulate.h"

#ifdef WIIMOTE_TRACKER_HAVE_OPENCV
#include <opencv2/calib3d.hpp>
#endif

#include <limits>
#include <optional>

namespace wiimote_tracker {
namespace {

using Way = geometry::TriangulationMethod;

geometry::TriangulationOptions optionsFor(Way method) {
  geometry::TriangulationOptions options;
  options.method = method;
  options.pixel_stddev = kBenchmarkPixelStddev;
  return options;
}

void take(const std::optional<geometry::TriangulatedPoint>& point,
          std::size_t i,
          TriangulationOutput* output) {
  if (!point)
    return;  // it stays NaN
  output->positions[i] = point->position;
  output->covariances[i] = point->covariance;
}

TriangulationMethod fromSights(const std::string& name, Way method) {
  return {name, [method](const TriangulationScene& scene) {
            std::vector<geometry::Sight> sights;  // of one point after the other
            for (const auto& pixels : scene.pixels) {
              for (std::size_t c = 0; c < pixels.size(); ++c)
                sights.push_back(*geometry::sightFromPixel(scene.cameras[c], pixels[c]));
            }
            return [sights, views = scene.cameras.size(),
                    options = optionsFor(method)](TriangulationOutput* output) {
              for (std::size_t i = 0; i < output->positions.size(); ++i)
                take(geometry::triangulate(&sights[i * views], views, options), i, output);
            };
          }};
}

/// Includes undistortion.
TriangulationMethod fromPixels() {
  return {"maximum likelihood, from pixels", [](const TriangulationScene& scene) {
            std::vector<std::vector<geometry::Observation>> observations;
            for (const auto& pixels : scene.pixels) {
              observations.emplace_back();
              for (std::size_t c = 0; c < pixels.size(); ++c)
                observations.back().push_back({&scene.cameras[c], pixels[c]});
            }
            return [observations,
                    options = optionsFor(Way::kMaximumLikelihood)](TriangulationOutput* output) {
              for (std::size_t i = 0; i < output->positions.size(); ++i)
                take(geometry::triangulate(observations[i], options), i, output);
            };
          }};
}

#ifdef WIIMOTE_TRACKER_HAVE_OPENCV
// As its users call it: all points at once.
cv::Mat_<double> projectionOf(const geometry::Camera& camera) {
  Eigen::Matrix3d K;
  K << camera.intrinsics.fx, 0, camera.intrinsics.cx, 0, camera.intrinsics.fy, camera.intrinsics.cy,
      0, 0, 1;
  Eigen::Matrix<double, 3, 4, Eigen::RowMajor> P =
      K * camera.world_from_camera.inverse(Eigen::Isometry).matrix().topRows<3>();
  return cv::Mat_<double>(3, 4, P.data()).clone();
}

std::function<void(TriangulationOutput*)> opencv(const TriangulationScene& scene) {
  const int count = static_cast<int>(scene.pixels.size());
  std::vector<cv::Mat_<double>> P, pixels;
  for (std::size_t c = 0; c < 2; ++c) {
    P.push_back(projectionOf(scene.cameras[c]));
    pixels.emplace_back(2, count);
    for (int i = 0; i < count; ++i) {
      pixels[c](0, i) = scene.pixels[static_cast<std::size_t>(i)][c].x();
      pixels[c](1, i) = scene.pixels[static_cast<std::size_t>(i)][c].y();
    }
  }
  return [P, pixels](TriangulationOutput* output) {
    cv::Mat_<double> h;
    cv::triangulatePoints(P[0], P[1], pixels[0], pixels[1], h);
    for (int i = 0; i < h.cols; ++i) {
      output->positions[static_cast<std::size_t>(i)] =
          Eigen::Vector3d(h(0, i), h(1, i), h(2, i)) / h(3, i);
    }
  };
}
#endif

}  // namespace

TriangulationOutput::TriangulationOutput(std::size_t points)
    : positions(points, Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN())),
      covariances(points, Eigen::Matrix3d::Constant(std::numeric_limits<double>::quiet_NaN())) {}

std::vector<TriangulationMethod> triangulationMethods([[maybe_unused]] std::size_t cameras) {
  std::vector<TriangulationMethod> methods = {
      fromSights("maximum likelihood", Way::kMaximumLikelihood), fromPixels(),
      fromSights("reweighted midpoint", Way::kReweightedMidpoint),
      fromSights("least squares", Way::kLeastSquares),
      fromSights("mean of closest points (paper)", Way::kMeanClosest)};
#ifdef WIIMOTE_TRACKER_HAVE_OPENCV
  if (cameras == 2)
    methods.push_back({"OpenCV triangulatePoints", opencv});
#endif
  return methods;
}

}  // namespace wiimote_tracker
