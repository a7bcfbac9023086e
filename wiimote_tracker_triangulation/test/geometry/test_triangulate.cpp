// Points from exact pixels, against OpenCV, and what must be refused.
#include "geometry/random_rigs.h"
#include "opencv_camera.h"
#include "wiimote_tracker_triangulation/geometry/triangulate.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <iostream>
#include <limits>

namespace wiimote_tracker::geometry::test {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr TriangulationMethod kMethods[] = {
    TriangulationMethod::kMeanClosest, TriangulationMethod::kLeastSquares,
    TriangulationMethod::kMaximumLikelihood, TriangulationMethod::kReweightedMidpoint};

TriangulationOptions optionsFor(TriangulationMethod method) {
  TriangulationOptions options;
  options.method = method;
  return options;
}

/// Pixels of a point by OpenCV, so that an error in our own camera cannot cancel out.
std::vector<Observation> observe(const Rig& rig, const Vector3d& point) {
  std::vector<Observation> observations;
  for (const RigCamera& camera : rig.cameras)
    observations.push_back({&camera.camera, OpenCvCamera(camera.camera).project(point)});
  return observations;
}

double squaredResiduals(const std::vector<Observation>& observations, const Vector3d& point) {
  double sum = 0.0;
  for (const Observation& o : observations)
    sum += (OpenCvCamera(*o.camera).project(point) - o.pixel).squaredNorm();
  return sum;
}

/// Pinhole cameras side by side along x, looking along z.
Rig parallelRig(const std::vector<double>& places) {
  Rig rig;
  for (const double x : places) {
    RigCamera camera;
    camera.camera.name = "camera_" + std::to_string(rig.cameras.size());
    camera.camera.world_from_camera.translation().x() = x;
    rig.cameras.push_back(camera);
  }
  return rig;
}

TEST(Triangulate, ExactPixelsGiveTheExactPoint) {
  Random random(11);
  double worst = 0.0;
  for (const int cameras : {2, 3, 4, 8}) {
    for (int i = 0; i < 50; ++i) {
      const Rig rig = randomRig(random, cameras);
      for (int k = 0; k < 10; ++k) {
        const Vector3d truth = random.inBox(1.0);
        const auto observations = observe(rig, truth);
        for (const TriangulationMethod method : kMethods) {
          const auto point = triangulate(observations, optionsFor(method));
          ASSERT_TRUE(point) << cameras << " cameras";
          const double error = (point->position - truth).norm();
          EXPECT_LT(error, 1e-6);
          worst = std::max(worst, error);
          EXPECT_LT(point->reprojection_error, 1e-6);
        }
      }
    }
  }
  RecordProperty("worst_error_m", std::to_string(worst));
}

TEST(Triangulate, MeanClosestIsTheMidpointOfTwoSkewRays) {
  // Ray along z through the origin, ray along -x through (5, 1, 3): closest points (0, 0, 3) and
  // (0, 1, 3).
  Rig rig = parallelRig({0.0, 0.0});
  rig.cameras[1].camera.world_from_camera =
      lookAt({5.0, 1.0, 3.0}, {0.0, 1.0, 3.0}, Vector3d::UnitZ());
  const Vector2d center(rig.cameras[0].camera.intrinsics.cx, rig.cameras[0].camera.intrinsics.cy);
  const std::vector<Observation> observations = {{&rig.cameras[0].camera, center},
                                                 {&rig.cameras[1].camera, center}};
  for (const TriangulationMethod method :
       {TriangulationMethod::kMeanClosest, TriangulationMethod::kLeastSquares}) {
    const auto point = triangulate(observations, optionsFor(method));
    ASSERT_TRUE(point);
    EXPECT_LT((point->position - Vector3d(0.0, 0.5, 3.0)).norm(), 1e-12);
  }
}

TEST(Triangulate, MeanClosestAveragesOverAllPairs) {
  // A third ray, along -z from above through (0.5, 0, .): parallel to the first, so that pair is
  // left out; with the second it meets in (0.5, 0.5, 3). Mean of (0, 0.5, 3) and (0.5, 0.5, 3).
  Rig rig = parallelRig({0.0, 0.0, 0.0});
  rig.cameras[1].camera.world_from_camera =
      lookAt({5.0, 1.0, 3.0}, {0.0, 1.0, 3.0}, Vector3d::UnitZ());
  rig.cameras[2].camera.world_from_camera =
      lookAt({0.5, 0.0, 9.0}, {0.5, 0.0, 0.0}, Vector3d::UnitY());
  const Vector2d center(rig.cameras[0].camera.intrinsics.cx, rig.cameras[0].camera.intrinsics.cy);
  std::vector<Observation> observations;
  for (const RigCamera& camera : rig.cameras)
    observations.push_back({&camera.camera, center});
  const auto point = triangulate(observations, optionsFor(TriangulationMethod::kMeanClosest));
  ASSERT_TRUE(point);
  EXPECT_LT((point->position - Vector3d(0.25, 0.5, 3.0)).norm(), 1e-12);
}

TEST(Triangulate, ReweightedMidpointCountsARayByItsRange) {
  // Rays along x, y and z that pass the origin at (0, a, 0), (b, 0, 0) and (0, 0, 0), from 2, 4 and
  // 8 m away: weights 16, 4 and 1 up to a factor. Each coordinate is the weighted mean of those of
  // the two rays across it.
  const double a = 0.001, b = 0.002;  // [m] so small that the first point's ranges are these
  const Vector3d passes[] = {{0.0, a, 0.0}, {b, 0.0, 0.0}, {0.0, 0.0, 0.0}};
  const double ranges[] = {2.0, 4.0, 8.0};
  Rig rig = parallelRig({0.0, 0.0, 0.0});
  std::vector<Observation> observations;
  for (int i = 0; i < 3; ++i) {
    geometry::Camera& camera = rig.cameras[i].camera;
    camera.world_from_camera =
        lookAt(passes[i] - ranges[i] * Vector3d::Unit(i), passes[i], Vector3d::Unit((i + 1) % 3));
    observations.push_back({&camera, Vector2d(camera.intrinsics.cx, camera.intrinsics.cy)});
  }
  const auto point =
      triangulate(observations, optionsFor(TriangulationMethod::kReweightedMidpoint));
  ASSERT_TRUE(point);
  const Vector3d expected((4.0 * b + 1.0 * 0.0) / 5.0, (16.0 * a + 1.0 * 0.0) / 17.0, 0.0);
  EXPECT_LT((point->position - expected).norm(), 1e-3 * a);
}

/// OpenCV's point (direct linear transform) from two undistorted views.
Vector3d opencvPoint(const std::vector<Observation>& observations) {
  cv::Mat_<double> P[2], pixels[2];
  for (int c = 0; c < 2; ++c) {
    const OpenCvCamera reference(*observations[c].camera);
    cv::Mat_<double> Rt;
    cv::hconcat(reference.R, reference.translation, Rt);
    P[c] = reference.K * Rt;
    pixels[c] = (cv::Mat_<double>(2, 1) << observations[c].pixel.x(), observations[c].pixel.y());
  }
  cv::Mat_<double> h;
  cv::triangulatePoints(P[0], P[1], pixels[0], pixels[1], h);
  return {h(0) / h(3), h(1) / h(3), h(2) / h(3)};
}

TEST(Triangulate, AgreesWithOpenCvForTwoViews) {
  constexpr double kNoise = 0.5;  // [px]
  Random random(12);
  double opencv_sum = 0.0;
  double sums[4] = {};
  for (int i = 0; i < 2000; ++i) {
    Rig rig = randomRig(random, 2);
    for (RigCamera& camera : rig.cameras)
      camera.camera.intrinsics.distortion = {};
    const Vector3d truth = random.inBox(1.0);
    std::vector<Observation> observations = observe(rig, truth);
    for (const TriangulationMethod method : kMethods) {
      const auto point = triangulate(observations, optionsFor(method));
      ASSERT_TRUE(point);
      EXPECT_LT((point->position - opencvPoint(observations)).norm(), 1e-9);
    }
    for (Observation& o : observations) {
      const double u = random.gaussian();
      const double v = random.gaussian();
      o.pixel += kNoise * Vector2d(u, v);
    }
    opencv_sum += (opencvPoint(observations) - truth).squaredNorm();
    for (int m = 0; m < 4; ++m) {
      const auto point = triangulate(observations, optionsFor(kMethods[m]));
      ASSERT_TRUE(point);
      sums[m] += (point->position - truth).squaredNorm();
    }
  }
  // They weight the two rays differently, so with noise only their accuracy agrees, not each point.
  for (const double sum : sums)
    EXPECT_NEAR(std::sqrt(sum / opencv_sum), 1.0, 0.05);
  EXPECT_LT(sums[2], 1.01 * opencv_sum) << "maximum likelihood must not be worse";
}

TEST(Triangulate, RefusesFewerThanTwoObservations) {
  Random random(13);
  const Rig rig = randomRig(random, 1);
  for (const TriangulationMethod method : kMethods) {
    EXPECT_FALSE(triangulate({}, optionsFor(method)));
    EXPECT_FALSE(triangulate(observe(rig, Vector3d::Zero()), optionsFor(method)));
  }
}

TEST(Triangulate, RefusesParallelRays) {
  const Rig rig = parallelRig({0.0, 1.0, 2.0});
  std::vector<Observation> observations;
  for (const RigCamera& camera : rig.cameras)
    observations.push_back({&camera.camera, Vector2d(600.0, 300.0)});
  for (const TriangulationMethod method : kMethods)
    EXPECT_FALSE(triangulate(observations, optionsFor(method)));
}

TEST(Triangulate, RefusesRaysThatFaceEachOther) {
  Rig rig = parallelRig({0.0, 0.0});
  rig.cameras[1].camera.world_from_camera =
      lookAt({0.0, 0.0, 8.0}, Vector3d::Zero(), Vector3d::UnitY());
  const auto observations = observe(rig, {0.0, 0.0, 4.0});
  for (const TriangulationMethod method : kMethods)
    EXPECT_FALSE(triangulate(observations, optionsFor(method)));
}

TEST(Triangulate, RefusesBelowTheMinimumAngleOnly) {
  // 1 m apart, 100 m away: 0.01 rad.
  const Rig rig = parallelRig({-0.5, 0.5});
  const auto observations = observe(rig, {0.0, 0.0, 100.0});
  for (const TriangulationMethod method : kMethods) {
    TriangulationOptions options = optionsFor(method);
    options.minimum_angle = 0.011;
    EXPECT_FALSE(triangulate(observations, options));
    options.minimum_angle = 0.009;
    EXPECT_TRUE(triangulate(observations, options));
  }
}

TEST(Triangulate, RefusesIdenticalCameras) {
  const Rig rig = parallelRig({0.0, 0.0});
  const auto observations = observe(rig, {0.3, 0.2, 4.0});
  for (const TriangulationMethod method : kMethods)
    EXPECT_FALSE(triangulate(observations, optionsFor(method)));
}

TEST(Triangulate, RefusesAPointBehindTheCameras) {
  // Rays that part from each other meet behind both cameras.
  const Rig rig = parallelRig({-0.5, 0.5});
  const std::vector<Observation> observations = {{&rig.cameras[0].camera, Vector2d(200.0, 400.0)},
                                                 {&rig.cameras[1].camera, Vector2d(900.0, 400.0)}};
  for (const TriangulationMethod method : kMethods)
    EXPECT_FALSE(triangulate(observations, optionsFor(method)));
}

TEST(Triangulate, RefusesAPointBehindOneOfManyCameras) {
  Rig rig = parallelRig({-1.0, 1.0, 0.0});
  rig.cameras[2].camera.world_from_camera.translation().z() = 10.0;  // looks away from the point
  const Vector3d truth(0.1, 0.2, 4.0);
  std::vector<Observation> observations = observe(rig, truth);
  // The line from the third camera through the point, backwards: its pixel is the same.
  for (const TriangulationMethod method : kMethods)
    EXPECT_FALSE(triangulate(observations, optionsFor(method)));
  observations.pop_back();
  for (const TriangulationMethod method : kMethods)
    EXPECT_TRUE(triangulate(observations, optionsFor(method)));
}

TEST(Triangulate, RefusesAPixelThatIsNoNumberOrHasNoRay) {
  Random random(14);
  Rig rig = randomRig(random, 3);
  std::vector<Observation> observations = observe(rig, Vector3d::Zero());
  observations[1].pixel.y() = std::numeric_limits<double>::quiet_NaN();
  for (const TriangulationMethod method : kMethods)
    EXPECT_FALSE(triangulate(observations, optionsFor(method)));
  observations = observe(rig, Vector3d::Zero());
  rig.cameras[2].camera.intrinsics.distortion = {-0.5, 0.0, 0.0, 0.0, 0.0};
  observations[2].pixel.x() = 1e6;
  for (const TriangulationMethod method : kMethods)
    EXPECT_FALSE(triangulate(observations, optionsFor(method)));
}

TEST(Triangulate, ReprojectionErrorIsTheRootMeanSquareDistance) {
  Random random(15);
  const Rig rig = randomRig(random, 3);
  std::vector<Observation> observations = observe(rig, Vector3d::Zero());
  for (Observation& o : observations)
    o.pixel += 3.0 * Vector2d(random.gaussian(), random.gaussian());
  for (const TriangulationMethod method : kMethods) {
    const auto point = triangulate(observations, optionsFor(method));
    ASSERT_TRUE(point);
    EXPECT_NEAR(point->reprojection_error,
                std::sqrt(squaredResiduals(observations, point->position) / 3.0), 1e-9);
  }
}

TEST(Triangulate, MaximumLikelihoodFitsThePixelsBest) {
  Random random(16);
  for (int i = 0; i < 100; ++i) {
    const Rig rig = randomRig(random, 4);
    std::vector<Observation> observations = observe(rig, random.inBox(1.0));
    for (Observation& o : observations)
      o.pixel += 2.0 * Vector2d(random.gaussian(), random.gaussian());
    const auto best =
        triangulate(observations, optionsFor(TriangulationMethod::kMaximumLikelihood));
    ASSERT_TRUE(best);
    for (const TriangulationMethod method :
         {TriangulationMethod::kMeanClosest, TriangulationMethod::kLeastSquares,
          TriangulationMethod::kReweightedMidpoint}) {
      EXPECT_LE(best->reprojection_error,
                triangulate(observations, optionsFor(method))->reprojection_error + 1e-12);
    }
    // A minimum: any small step is worse.
    for (int a = 0; a < 3; ++a) {
      for (const double step : {-1e-4, 1e-4}) {
        const Vector3d moved = best->position + step * Vector3d::Unit(a);
        EXPECT_GT(std::sqrt(squaredResiduals(observations, moved) / 4.0), best->reprojection_error);
      }
    }
  }
}

/// By how much Newton's method with numerical derivatives lowers the cost of a point [px^2].
double gainLeft(const std::vector<Observation>& observations, const Vector3d& point) {
  const double h = 1e-3;  // [m]
  const auto cost = [&](const Vector3d& offset) {
    return squaredResiduals(observations, point + offset);
  };
  Vector3d gradient;
  Eigen::Matrix3d hessian;
  for (int a = 0; a < 3; ++a) {
    const Vector3d ea = h * Vector3d::Unit(a);
    gradient[a] = (cost(ea) - cost(-ea)) / (2.0 * h);
    for (int b = 0; b < 3; ++b) {
      const Vector3d eb = h * Vector3d::Unit(b);
      hessian(a, b) =
          (cost(ea + eb) - cost(ea - eb) - cost(eb - ea) + cost(-ea - eb)) / (4.0 * h * h);
    }
  }
  return 0.5 * gradient.dot(hessian.ldlt().solve(gradient));
}

TEST(Triangulate, MaximumLikelihoodLeavesNothingToGain) {
  Random random(17);
  double worst = 0.0;
  for (int i = 0; i < 300; ++i) {
    Rig rig = randomRig(random, 2 + i % 4);
    if (i % 3 == 0) {  // side by side, badly determined
      rig = parallelRig({0.0, 0.3});
      for (RigCamera& camera : rig.cameras)
        camera.camera.world_from_camera.translation().z() = -6.0;
    }
    std::vector<Observation> observations = observe(rig, random.inBox(0.5));
    for (Observation& o : observations)
      o.pixel += random.uniform(0.1, 3.0) * Vector2d(random.gaussian(), random.gaussian());
    const auto point =
        triangulate(observations, optionsFor(TriangulationMethod::kMaximumLikelihood));
    ASSERT_TRUE(point);
    const double cost = squaredResiduals(observations, point->position);
    const double gain = gainLeft(observations, point->position) / cost;
    EXPECT_LT(gain, 1e-4);
    worst = std::max(worst, gain);
  }
  std::cout << "worst gain left: " << worst << " of the cost" << std::endl;
}

TEST(Triangulate, SightsGiveTheSamePointAsObservations) {
  Random random(19);
  for (int i = 0; i < 100; ++i) {
    const Rig rig = randomRig(random, 2 + i % 7);
    std::vector<Observation> observations = observe(rig, random.inBox(1.0));
    std::vector<Sight> sights;
    for (Observation& o : observations) {
      o.pixel += 0.5 * Vector2d(random.gaussian(), random.gaussian());
      sights.push_back(*sightFromPixel(*o.camera, o.pixel));
    }
    for (const TriangulationMethod method : kMethods) {
      const auto point = triangulate(observations, optionsFor(method));
      const auto same = triangulate(sights.data(), sights.size(), optionsFor(method));
      ASSERT_TRUE(point && same);
      EXPECT_EQ(point->position, same->position);
      EXPECT_EQ(point->covariance, same->covariance);
      EXPECT_NEAR(point->reprojection_error, same->reprojection_error,
                  2e-3 * point->reprojection_error);
    }
  }
}

TEST(Triangulate, TakesAnyNumberOfObservations) {
  Random random(18);
  const Rig rig = randomRig(random, 40);
  const Vector3d truth(0.1, 0.2, 0.3);
  for (const TriangulationMethod method : kMethods) {
    const auto point = triangulate(observe(rig, truth), optionsFor(method));
    ASSERT_TRUE(point);
    EXPECT_LT((point->position - truth).norm(), 1e-9);
  }
}

}  // namespace
}  // namespace wiimote_tracker::geometry::test
