// The equidistant lens, compared with OpenCV's cv::fisheye, and the limits of its validity.
#include "expect_derivatives.h"
#include "geometry/random_rigs.h"
#include "wiimote_tracker_triangulation/geometry/camera.h"
#include "wiimote_tracker_triangulation/geometry/error.h"
#include "wiimote_tracker_triangulation/geometry/sight.h"
#include "wiimote_tracker_triangulation/geometry/triangulate.h"

#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>

#include <cmath>
#include <limits>
#include <vector>

namespace wiimote_tracker::geometry {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using test::Random;

/// A lens without coefficients: the radius is the angle itself.
Intrinsics ideal() {
  Intrinsics intrinsics;
  intrinsics.distortion_model = DistortionModel::kEquidistant;
  intrinsics.fx = intrinsics.fy = 500.0;
  intrinsics.cx = 512.0;
  intrinsics.cy = 384.0;
  return intrinsics;
}

/// Whether a lens projects a point at this distance from the axis, at depth 1.
bool isBeforeFold(const Intrinsics& lens, double distance) {
  Camera camera;
  camera.intrinsics = lens;
  return camera.project({distance, 0.0, 1.0}).has_value();
}

/// Up to about 70 degrees off the axis.
Vector2d randomPixel(const Intrinsics& intrinsics, Random& random) {
  const double radius = random.uniform(0.0, 1.1);
  const double side = random.uniform(-M_PI, M_PI);
  return {intrinsics.cx + intrinsics.fx * radius * std::cos(side),
          intrinsics.cy + intrinsics.fy * radius * std::sin(side)};
}

TEST(Fisheye, ProjectsAsOpenCvDoes) {
  Random random(1);
  for (int i = 0; i < 100; ++i) {
    const Intrinsics lens = test::randomFisheye(random);
    const auto& k = lens.distortion;
    const cv::Matx33d K(lens.fx, 0, lens.cx, 0, lens.fy, lens.cy, 0, 0, 1);
    const cv::Vec4d D(k[0], k[1], k[2], k[3]);
    for (int n = 0; n < 20; ++n) {
      const double angle = random.uniform(0.0, 1.3);
      const double side = random.uniform(-M_PI, M_PI);
      const Vector3d point(2.0 * std::sin(angle) * std::cos(side),
                           2.0 * std::sin(angle) * std::sin(side), 2.0 * std::cos(angle));
      std::vector<cv::Point2d> reference;
      cv::fisheye::projectPoints(std::vector<cv::Point3d>{{point.x(), point.y(), point.z()}},
                                 reference, cv::Vec3d(), cv::Vec3d(), K, D);
      const Vector2d pixel = lens.pixelFromNormalized(point.head<2>() / point.z());
      EXPECT_LT((pixel - Vector2d(reference[0].x, reference[0].y)).norm(), 1e-9);
    }
  }
}

TEST(Fisheye, PixelToRayToPixelIsExact) {
  Random random(2);
  for (int i = 0; i < 10000; ++i) {
    const Intrinsics lens = test::randomFisheye(random);
    const Vector2d pixel = randomPixel(lens, random);
    const auto normalized = lens.normalizedFromPixel(pixel);
    ASSERT_TRUE(normalized);
    ASSERT_LT((lens.pixelFromNormalized(*normalized) - pixel).norm(), 1e-9);
  }
}

TEST(Fisheye, AnglesAreRadiiWithoutCoefficients) {
  const Intrinsics lens = ideal();
  for (const double angle : {1e-9, 0.3, 1.0, 1.5}) {
    const auto normalized = lens.normalizedFromPixel({512.0 + 500.0 * angle, 384.0});
    ASSERT_TRUE(normalized);
    EXPECT_NEAR(normalized->x(), std::tan(angle), 1e-11 * std::tan(angle) + 1e-15);
    EXPECT_EQ(normalized->y(), 0.0);
  }
  EXPECT_EQ(*lens.normalizedFromPixel({512.0, 384.0}), Vector2d::Zero());
}

TEST(Fisheye, DerivativesAreThoseOfFiniteDifferences) {
  Random random(4);
  for (int i = 0; i < 50; ++i) {
    Camera camera = test::randomRig(random, 1).cameras[0].camera;
    camera.intrinsics = test::randomFisheye(random);
    test::expectDerivatives(camera, random.inBox(1.0));
  }
  // On the axis, where radii have no direction.
  Eigen::Matrix2d jacobian;
  ideal().pixelFromNormalized({0.0, 0.0}, &jacobian);
  EXPECT_EQ(jacobian, 500.0 * Eigen::Matrix2d::Identity());
  ideal().pixelFromNormalized({1e-9, -1e-9}, &jacobian);
  EXPECT_LT((jacobian - 500.0 * Eigen::Matrix2d::Identity()).norm(), 1e-9);
}

TEST(Fisheye, EndsBeforeARightAngle) {
  Camera camera;
  camera.intrinsics = ideal();
  EXPECT_TRUE(camera.intrinsics.normalizedFromPixel({512.0 + 500.0 * 1.549, 384.0}));
  EXPECT_FALSE(camera.intrinsics.normalizedFromPixel({512.0 + 500.0 * 1.551, 384.0}));
  EXPECT_TRUE(camera.project({std::tan(1.549), 0.0, 1.0}));
  EXPECT_FALSE(camera.project({std::tan(1.551), 0.0, 1.0}));
  EXPECT_FALSE(camera.project({1.0, 0.0, 0.0}));
  EXPECT_FALSE(camera.project({1.0, 0.0, -1.0}));
}

TEST(Fisheye, RefusesWhatLiesBeyondTheFold) {
  // a - a^3 / 3 turns back at a = 1, where it is 2/3.
  Intrinsics lens = ideal();
  lens.distortion[0] = -1.0 / 3.0;
  EXPECT_TRUE(isBeforeFold(lens, std::tan(0.99)));
  EXPECT_FALSE(isBeforeFold(lens, std::tan(1.01)));
  EXPECT_TRUE(lens.normalizedFromPixel({512.0 + 500.0 * 0.666, 384.0}));
  EXPECT_FALSE(lens.normalizedFromPixel({512.0 + 500.0 * 0.667, 384.0}));
  // The branch from the centre, not the one that comes back.
  const double radius = 0.6 - 0.6 * 0.6 * 0.6 / 3.0;
  EXPECT_NEAR(lens.normalizedFromPixel({512.0 + 500.0 * radius, 384.0})->x(), std::tan(0.6), 1e-12);
}

TEST(Fisheye, FindsAFoldThatAHigherCoefficientHidesAgain) {
  // With s = a^2 the slope 1 - 6 s + 8 s^2 is negative between s = 0.25 and 0.5, positive after.
  Intrinsics lens = ideal();
  lens.distortion = {-2.0, 1.6, 0.0, 0.0, 0.0};
  EXPECT_TRUE(isBeforeFold(lens, std::tan(0.499)));
  EXPECT_FALSE(isBeforeFold(lens, std::tan(0.501)));
  EXPECT_FALSE(isBeforeFold(lens, std::tan(0.9)));
  // 9 k4 (s - 0.3)^2 (s - 0.5)^2 plus a constant: near zero twice, but never zero.
  const auto grazing = [](double above) {
    const double c = 1.0 / (0.0225 + above);
    Intrinsics graze = ideal();
    graze.distortion = {c * -0.24 / 3.0, c * 0.94 / 5.0, c * -1.6 / 7.0, c * 1.0 / 9.0, 0.0};
    return isBeforeFold(graze, std::tan(0.9));
  };
  EXPECT_TRUE(grazing(1e-5));
  EXPECT_FALSE(grazing(-1e-5));
}

TEST(Fisheye, RefusesPixelsThatAreNoNumbers) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(ideal().normalizedFromPixel({nan, 0.0}));
  EXPECT_FALSE(ideal().normalizedFromPixel({0.0, std::numeric_limits<double>::infinity()}));
  EXPECT_FALSE(isBeforeFold(ideal(), nan));
}

TEST(Fisheye, PointsAreTriangulatedAsWithAnyLens) {
  Random random(5);
  for (int i = 0; i < 100; ++i) {
    Rig rig = test::randomRig(random, 3);
    for (RigCamera& camera : rig.cameras)
      camera.camera.intrinsics = test::randomFisheye(random);
    rig.cameras[0].camera.intrinsics = test::randomIntrinsics(random);  // a bare one among them
    const Vector3d truth = random.inBox(1.0);
    std::vector<Observation> observations;
    for (const RigCamera& camera : rig.cameras)
      observations.push_back({&camera.camera, *camera.camera.project(truth)});
    const auto point = triangulate(observations, {});
    ASSERT_TRUE(point);
    EXPECT_LT((point->position - truth).norm(), 1e-6);
    EXPECT_LT(point->reprojection_error, 1e-4);
  }
}

TEST(Fisheye, HasFourCoefficients) {
  Intrinsics lens = ideal();
  EXPECT_NO_THROW(lens.check());
  lens.distortion[4] = 0.1;
  EXPECT_THROW(lens.check(), InvalidRigError);
  EXPECT_EQ(std::string("equidistant"), nameOf(lens.distortion_model));
  EXPECT_EQ(DistortionModel::kEquidistant, distortionModelFromName("equidistant"));
  EXPECT_EQ(std::nullopt, distortionModelFromName("fisheye"));
}

// The paper's virtual model is a pinhole, whatever the lens.
TEST(Fisheye, ImageCenterRaysAreAPinholes) {
  Random random(6);
  Rig rig = test::randomRig(random, 1);
  rig.cameras[0].camera.intrinsics = test::randomFisheye(random);
  rig.ray_model = RayModel::kImageCenter;
  const Camera camera = rig.rayCamera(rig.cameras[0]);
  const Intrinsics& lens = camera.intrinsics;
  EXPECT_NO_THROW(lens.check());
  EXPECT_EQ(lens.pixelFromNormalized({0.5, 0.25}),
            Vector2d(lens.cx + 0.5 * lens.fx, lens.cy + 0.25 * lens.fy));
}

}  // namespace
}  // namespace wiimote_tracker::geometry
