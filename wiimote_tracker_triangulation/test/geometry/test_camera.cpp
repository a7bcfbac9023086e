// The camera model, compared with OpenCV's, and the limits of its validity.
#include "expect_derivatives.h"
#include "geometry/random_rigs.h"
#include "opencv_camera.h"
#include "refusal_of.h"
#include "wiimote_tracker_triangulation/geometry/camera.h"
#include "wiimote_tracker_triangulation/geometry/error.h"
#include "wiimote_tracker_triangulation/geometry/sight.h"
#include "wiimote_tracker_triangulation/geometry/so3.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace wiimote_tracker::geometry::test {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Strong barrel distortion: the radius r - 0.5 r^3 turns back at r = sqrt(2/3), where it is 0.544.
Intrinsics folding() {
  Intrinsics intrinsics;
  intrinsics.distortion = {-0.5, 0.0, 0.0, 0.0, 0.0};
  return intrinsics;
}

TEST(Camera, ProjectsAsOpenCvDoes) {
  Random random(1);
  for (int i = 0; i < 100; ++i) {
    const Camera camera = randomRig(random, 1).cameras[0].camera;
    const OpenCvCamera reference(camera);
    for (int k = 0; k < 20; ++k) {
      const Vector3d point = random.inBox(1.0);
      const auto pixel = camera.project(point);
      ASSERT_TRUE(pixel);
      EXPECT_LT((*pixel - reference.project(point)).norm(), 1e-9);
    }
  }
}

TEST(Camera, UndistortsAsOpenCvDoes) {
  Random random(2);
  for (int i = 0; i < 100; ++i) {
    const Camera camera = randomRig(random, 1).cameras[0].camera;
    const OpenCvCamera reference(camera);
    const Vector2d pixel(random.uniform(0, camera.intrinsics.width - 1),
                         random.uniform(0, camera.intrinsics.height - 1));
    std::vector<cv::Point2d> undistorted;
    cv::undistortPoints(
        std::vector<cv::Point2d>{{pixel.x(), pixel.y()}}, undistorted, reference.K, reference.D,
        cv::noArray(), cv::noArray(),
        cv::TermCriteria(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 500, 1e-15));
    const auto normalized = camera.intrinsics.normalizedFromPixel(pixel);
    ASSERT_TRUE(normalized);
    EXPECT_NEAR(normalized->x(), undistorted[0].x, 1e-9);
    EXPECT_NEAR(normalized->y(), undistorted[0].y, 1e-9);
  }
}

TEST(Camera, PixelToRayToPixelIsExact) {
  Random random(3);
  for (int i = 0; i < 10000; ++i) {
    const Intrinsics intrinsics = randomIntrinsics(random);
    const Vector2d pixel(random.uniform(0, intrinsics.width - 1),
                         random.uniform(0, intrinsics.height - 1));
    const auto normalized = intrinsics.normalizedFromPixel(pixel);
    ASSERT_TRUE(normalized);
    ASSERT_LT((intrinsics.pixelFromNormalized(*normalized) - pixel).norm(), 1e-9);
  }
}

TEST(Camera, DerivativesAreThoseOfFiniteDifferences) {
  Random random(4);
  for (int i = 0; i < 50; ++i) {
    const Camera camera = randomRig(random, 1).cameras[0].camera;
    expectDerivatives(camera, random.inBox(1.0));
  }
}

TEST(Camera, RayPassesThroughThePoint) {
  Random random(5);
  for (int i = 0; i < 100; ++i) {
    const Camera camera = randomRig(random, 1).cameras[0].camera;
    const Vector3d point = random.inBox(1.0);
    const auto sight = sightFromPixel(camera, *camera.project(point));
    ASSERT_TRUE(sight);
    EXPECT_NEAR(sight->direction.norm(), 1.0, 1e-14);
    EXPECT_GT(sight->direction.dot(point - sight->origin), 0.0);
    EXPECT_LT(sight->direction.cross(point - sight->origin).norm(), 1e-11);
  }
}

TEST(Camera, RefusesWhatLiesBehindOrBesideIt) {
  Camera camera;
  EXPECT_TRUE(camera.project({0.0, 0.0, 1.0}));
  EXPECT_FALSE(camera.project({0.0, 0.0, -1.0}));
  EXPECT_FALSE(camera.project({1.0, 0.0, 0.0}));
  EXPECT_FALSE(camera.project({kNaN, 0.0, 1.0}));
  EXPECT_FALSE(camera.sees({0.0, 0.0, -1.0}));
}

TEST(Camera, RefusesPixelsBeyondTheFold) {
  const Intrinsics intrinsics = folding();
  const auto pixelAt = [&](double distorted_radius) {
    return Vector2d(intrinsics.cx + intrinsics.fx * distorted_radius, intrinsics.cy);
  };
  EXPECT_TRUE(intrinsics.normalizedFromPixel(pixelAt(0.540)));
  EXPECT_FALSE(intrinsics.normalizedFromPixel(pixelAt(0.548)));
  EXPECT_FALSE(intrinsics.normalizedFromPixel(pixelAt(5.0)));
  // The branch from the centre, not the one that comes back: r = 0.6 gives 0.492.
  EXPECT_NEAR(intrinsics.normalizedFromPixel(pixelAt(0.6 - 0.5 * 0.216))->x(), 0.6, 1e-12);
}

TEST(Camera, DoesNotSeeAGhostThatTheLensPolynomialFoldsBackIntoTheImage) {
  Camera camera;
  camera.intrinsics = folding();
  // r = 1.4 is far beyond the fold; the bare polynomial would put it at 0.028, in mid image.
  const Vector3d point(1.4, 0.0, 1.0);
  EXPECT_TRUE(camera.intrinsics.pixelFromNormalized({1.4, 0.0}).x() < 600.0);
  EXPECT_FALSE(camera.project(point));
  EXPECT_FALSE(camera.sees(point));
}

TEST(Camera, FindsAFoldThatAHigherCoefficientHidesAgain) {
  // 1 + 3 k1 s + 5 k2 s^2 = 1 - 6 s + 8 s^2: negative between s = 0.25 and 0.5, positive after.
  Camera camera;
  camera.intrinsics.distortion = {-2.0, 1.6, 0.0, 0.0, 0.0};
  EXPECT_TRUE(camera.project({0.49, 0.0, 1.0}));
  EXPECT_FALSE(camera.project({0.6, 0.0, 1.0}));
  EXPECT_FALSE(camera.project({0.9, 0.0, 1.0}));
}

TEST(Camera, RefusesPixelsThatAreNoNumbers) {
  const Intrinsics intrinsics;
  EXPECT_FALSE(intrinsics.normalizedFromPixel({kNaN, 0.0}));
  EXPECT_FALSE(intrinsics.normalizedFromPixel({0.0, std::numeric_limits<double>::infinity()}));
  EXPECT_FALSE(sightFromPixel(Camera(), {0.0, kNaN}));
}

TEST(Camera, ImageSizeIsData) {
  Camera small;
  small.intrinsics.width = 128;
  small.intrinsics.height = 96;
  small.intrinsics.cx = 63.5;
  small.intrinsics.cy = 47.5;
  small.intrinsics.fx = small.intrinsics.fy = 100.0;
  const auto seen = [&](double u, double v) {
    return small.sees({(u - 63.5) / 100.0, (v - 47.5) / 100.0, 1.0});
  };
  EXPECT_TRUE(seen(0.01, 0.01));
  EXPECT_TRUE(seen(126.9, 94.9));
  EXPECT_FALSE(seen(127.1, 50.0));
  EXPECT_FALSE(seen(50.0, 95.1));
  EXPECT_FALSE(seen(-0.1, 50.0));
}

TEST(Camera, LooksAtItsTargetUpright) {
  const Vector3d position(3.0, -2.0, 2.0);
  const Vector3d target(0.5, 1.0, 0.25);
  Camera camera;
  camera.world_from_camera = lookAt(position, target, Vector3d(0.0, 0.0, 5.0));
  const Eigen::Matrix3d R = camera.world_from_camera.linear();
  EXPECT_TRUE((R * R.transpose()).isIdentity(1e-14));
  EXPECT_NEAR(R.determinant(), 1.0, 1e-14);
  EXPECT_LT((camera.center() - position).norm(), 1e-15);
  EXPECT_LT((*camera.project(target) - Vector2d(535.0, 401.7)).norm(), 1e-9);
  EXPECT_NEAR(R.col(0).z(), 0.0, 1e-15) << "the image's x axis must be horizontal";
  EXPECT_LT(camera.project(target + Vector3d::UnitZ())->y(), 401.7) << "up is up in the image";
  EXPECT_THROW(lookAt(position, position + Vector3d::UnitZ(), Vector3d::UnitZ()), InvalidRigError);
  EXPECT_THROW(lookAt(position, position, Vector3d::UnitZ()), InvalidRigError);
}

TEST(Camera, CheckNamesTheBadValue) {
  const auto message = [](const Intrinsics& intrinsics) -> std::string {
    return refusalOf([&] { intrinsics.check(); });
  };
  Intrinsics bad;
  EXPECT_EQ("not refused", message(bad));
  bad.fx = 0.0;
  EXPECT_NE(std::string::npos, message(bad).find("fx"));
  bad = Intrinsics();
  bad.cy = kNaN;
  EXPECT_NE(std::string::npos, message(bad).find("cy"));
  bad = Intrinsics();
  bad.height = 0;
  EXPECT_NE(std::string::npos, message(bad).find("height"));
  bad = Intrinsics();
  bad.distortion[2] = kNaN;
  EXPECT_NE(std::string::npos, message(bad).find("distortion"));
}

TEST(So3, AngleBetweenIsThatOfTheTurn) {
  const Eigen::Matrix3d a = so3::exp({0.4, -1.0, 2.0}).toRotationMatrix();
  const Vector3d axis = Vector3d(1.0, -2.0, 0.5).normalized();
  for (const double angle : {0.0, 1e-6, 1.0, M_PI}) {
    EXPECT_NEAR(angle, so3::angleBetween(a, a * so3::exp(angle * axis)), 1e-12);
    EXPECT_NEAR(angle, so3::angleBetween(so3::exp(-angle * axis) * a, a), 1e-12);
  }
}

TEST(So3, BetweenTurnsOneDirectionToTheOtherTheShortestWay) {
  const Vector3d from(0.3, -2.0, 1.0);
  for (const Vector3d& to : {Vector3d(1.0, 0.5, -3.0), Vector3d(2.0 * from), Vector3d(-0.5 * from),
                             Vector3d(-from + Vector3d(1e-8, 0.0, 0.0))}) {
    const Eigen::AngleAxisd turn = so3::between(from, to);
    // So near to opposite, rounding turns the axis, and the angle by acos, by some 1e-8.
    EXPECT_TRUE((turn * from.normalized()).isApprox(to.normalized(), 1e-7)) << to.transpose();
    EXPECT_NEAR(std::acos(std::clamp(from.normalized().dot(to.normalized()), -1.0, 1.0)),
                turn.angle(), 1e-7);
    EXPECT_NEAR(1.0, turn.axis().norm(), 1e-12);
  }
}

}  // namespace
}  // namespace wiimote_tracker::geometry::test
