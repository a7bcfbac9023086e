#include "solution.h"
#include "wiimote_tracker_calibration/import/pinhole.h"
#include "wiimote_tracker_calibration/import/recording.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace wiimote_tracker::import {
namespace {

geometry::Camera cameraAt(double angle) {
  geometry::Camera camera;
  camera.intrinsics.width = 640;
  camera.intrinsics.height = 480;
  camera.intrinsics.fx = 500.0;
  camera.intrinsics.fy = 505.0;
  camera.intrinsics.cx = 330.0;
  camera.intrinsics.cy = 235.0;
  camera.intrinsics.distortion = {-0.25, 0.07, 5e-4, -4e-4, 0.0};
  camera.world_from_camera = geometry::lookAt({4.0 * std::cos(angle), 4.0 * std::sin(angle), 2.0},
                                              {0.1, 0.0, 1.0}, {0.0, 0.0, 1.0});
  return camera;
}

/// Four cameras with distortion around a room, and their pixels of 150 positions of a light.
struct Room {
  std::vector<geometry::Camera> cameras;
  std::vector<Eigen::Vector3d> points;
  Recording recording;

  Room() {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    for (int i = 0; i < 4; ++i) {
      cameras.push_back(cameraAt(1.5 * i + 0.3 * unit(random)));
      RecordedCamera recorded;
      recorded.name = "camera_" + std::to_string(i + 1);
      recorded.intrinsics = cameras.back().intrinsics;
      recorded.center = cameras.back().center();
      recording.cameras.push_back(recorded);
    }
    for (int i = 0; i < 150; ++i) {
      points.emplace_back(2.0 * unit(random) - 1.0, 2.0 * unit(random) - 1.0, 2.0 * unit(random));
      Pixels pixels;
      for (const geometry::Camera& camera : cameras)
        pixels.push_back(camera.sees(points.back()) ? camera.project(points.back()) : std::nullopt);
      recording.frames.push_back(pixels);
    }
  }
};

ProjectionMatrix projectionOf(const Eigen::Matrix3d& k,
                              const Eigen::Isometry3d& world_from_camera) {
  return k * world_from_camera.inverse().matrix().topRows<3>();
}

TEST(Pinhole, decomposesAMatrix) {
  Eigen::Matrix3d k;
  k << 1200.0, -11.0, 340.0, 0.0, 1250.0, 230.0, 0.0, 0.0, 1.0;
  const Eigen::Isometry3d pose = cameraAt(0.7).world_from_camera;
  for (const double scale : {1.0, -3.0, 0.01}) {
    const Pinhole pinhole = takeApart(scale * projectionOf(k, pose), "camera");
    EXPECT_NEAR(pinhole.fx, 1200.0, 1e-9);
    EXPECT_NEAR(pinhole.fy, 1250.0, 1e-9);
    EXPECT_NEAR(pinhole.cx, 340.0, 1e-9);
    EXPECT_NEAR(pinhole.cy, 230.0, 1e-9);
    EXPECT_NEAR(pinhole.skew, -11.0, 1e-9);
    EXPECT_TRUE(pinhole.world_from_camera.isApprox(pose, 1e-10));
  }
}

TEST(Pinhole, refusesASingularMatrix) {
  ProjectionMatrix projection;
  projection << 1, 2, 3, 4, 2, 4, 6, 8, 0, 0, 1, 1;
  EXPECT_THROW(takeApart(projection, "camera"), ImportError);
}

TEST(ImportSolution, intrinsicsAloneGiveThePosesInTheFrameOfTheCentres) {
  const Room room;
  const Solution solution = solve(room.recording);
  ASSERT_EQ(solution.rig.cameras.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_TRUE(solution.rig.cameras[i].camera.world_from_camera.isApprox(
        room.cameras[i].world_from_camera, 1e-6));
    EXPECT_LT(solution.rig.cameras[i].residual_px, 1e-4);
  }
  EXPECT_EQ(solution.frames, room.recording.frames);
  ASSERT_TRUE(solution.reference);
  ASSERT_EQ(solution.reference->points.size(), room.points.size());
  int known = 0;
  for (std::size_t i = 0; i < room.points.size(); ++i) {
    if (solution.reference->points[i]) {
      ++known;
      EXPECT_LT((*solution.reference->points[i] - room.points[i]).norm(), 1e-6);
    }
  }
  EXPECT_GT(known, 100);
}

TEST(ImportSolution, wrongCentresAreFixedInTheReferenceOnly) {
  Room room;
  *room.recording.cameras[2].center += Eigen::Vector3d(0.05, 0.0, 0.0);
  const Solution solution = solve(room.recording);
  EXPECT_LT(solution.rig.cameras[2].residual_px, 1e-4);
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_EQ(solution.reference->rig.cameras[i].camera.center(),
              *room.recording.cameras[i].center);
  EXPECT_GT(solution.reference->rig.cameras[2].residual_px, 0.1);
}

TEST(ImportSolution, withoutCentresThereIsNoReference) {
  Room room;
  for (RecordedCamera& camera : room.recording.cameras)
    camera.center.reset();
  const Solution solution = solve(room.recording);
  EXPECT_FALSE(solution.reference);
  EXPECT_LT(solution.rig.cameras[0].residual_px, 1e-4);
}

TEST(ImportSolution, centresOnALineAreRefusedWithAdvice) {
  Room room;
  for (std::size_t i = 0; i < 4; ++i)
    room.recording.cameras[i].center = Eigen::Vector3d(static_cast<double>(i), 0.0, 0.0);
  try {
    solve(room.recording);
    FAIL() << "was not refused";
  } catch (const ImportError& error) {
    EXPECT_NE(std::string(error.what()).find("remove Cst.dat or original_cam_centers.dat"),
              std::string::npos);
  }
}

TEST(ImportSolution, tooFewFramesAreRefused) {
  Room room;
  room.recording.frames.resize(5);
  try {
    solve(room.recording);
    FAIL() << "was not refused";
  } catch (const ImportError& error) {
    EXPECT_EQ(std::string(error.what()).find("the cameras cannot be solved: "), 0u) << error.what();
  }
}

/// The shipped matrix of a camera with skew, undistorted with another focal length and principal
/// point: undistorted pixel = K_matrix [R | t] X, with distorted = K_lens distort(K_lens^-1
/// undistorted).
class ShippedMatrices : public testing::TestWithParam<bool> {};

TEST_P(ShippedMatrices, giveTheTruePointsInTheFrameOfTheCentres) {
  const bool mirrored = GetParam();
  Room room;
  Eigen::Matrix3d k;
  k << 520.0, -4.0, 322.0, 0.0, 531.0, 241.0, 0.0, 0.0, 1.0;
  // The matrices have another frame and scale than the centres.
  Eigen::Matrix4d other = Eigen::Matrix4d::Identity();
  other.topLeftCorner<3, 3>() =
      7.0 * Eigen::AngleAxisd(0.8, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  other.topRightCorner<3, 1>() << 1.0, -2.0, 3.0;
  if (mirrored)
    other.row(1) *= -1.0;
  for (std::size_t i = 0; i < room.cameras.size(); ++i) {
    const geometry::Camera& camera = room.cameras[i];
    const ProjectionMatrix projection = projectionOf(k, camera.world_from_camera);
    room.recording.cameras[i].projection = (i % 2 == 0 ? -2.0 : 0.5) * projection * other.inverse();
    const geometry::Intrinsics& lens = room.recording.cameras[i].intrinsics;
    for (std::size_t frame = 0; frame < room.points.size(); ++frame) {
      const Eigen::Vector3d h = projection * room.points[frame].homogeneous();
      const Eigen::Vector2d undistorted = h.hnormalized();
      const Eigen::Vector2d distorted = lens.pixelFromNormalized(
          {(undistorted.x() - lens.cx) / lens.fx, (undistorted.y() - lens.cy) / lens.fy});
      const bool inside = h.z() > 0.0 && (distorted.array() >= 0.0).all() &&
                          distorted.x() <= 639.0 && distorted.y() <= 479.0;
      room.recording.frames[frame][i] = inside ? std::make_optional(distorted) : std::nullopt;
    }
  }
  room.recording.points = room.points;

  const Solution solution = solve(room.recording);
  std::size_t seen = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const geometry::Camera& camera = solution.rig.cameras[i].camera;
    EXPECT_TRUE(camera.world_from_camera.isApprox(room.cameras[i].world_from_camera, 1e-8));
    for (std::size_t frame = 0; frame < room.points.size(); ++frame) {
      const auto& pixel = solution.frames[frame][i];
      if (!pixel)
        continue;
      ++seen;
      const auto projected = camera.project(room.points[frame]);
      ASSERT_TRUE(projected);
      EXPECT_LT((*projected - *pixel).norm(), 1e-6);
      EXPECT_GE(pixel->minCoeff(), 0.0);
      EXPECT_LE(pixel->x(), camera.intrinsics.width - 1.0);
      EXPECT_LE(pixel->y(), camera.intrinsics.height - 1.0);
    }
  }
  EXPECT_GT(seen, 300u);
  ASSERT_TRUE(solution.reference);
  EXPECT_EQ(*solution.reference->points[5], room.points[5]);
}

INSTANTIATE_TEST_SUITE_P(ImportSolution, ShippedMatrices, testing::Bool());

TEST(ImportSolution, flydrasPointsFitItsMatrices) {
  const Recording recording = readRecording(FLYDRA_EXCERPT);
  ASSERT_EQ(recording.cameras.size(), 5u);
  ASSERT_EQ(recording.frames.size(), 102u);
  const Solution solution = solve(recording);
  std::vector<double> errors;
  for (std::size_t frame = 0; frame < recording.frames.size(); ++frame) {
    for (std::size_t i = 0; i < 5; ++i) {
      if (!solution.frames[frame][i])
        continue;
      const auto projected = solution.rig.cameras[i].camera.project(recording.points[frame]);
      ASSERT_TRUE(projected);
      errors.push_back((*projected - *solution.frames[frame][i]).norm());
    }
  }
  // The points were shipped in millimetres in the frame of Cst.dat, the matrices in a mirrored
  // frame of another scale: a median of a quarter pixel shows that both were aligned.
  std::sort(errors.begin(), errors.end());
  ASSERT_GT(errors.size(), 400u);
  EXPECT_LT(errors[errors.size() / 2], 0.25);
  for (std::size_t i = 0; i < 5; ++i)
    EXPECT_LT((solution.rig.cameras[i].camera.center() - *recording.cameras[i].center).norm(),
              1e-6);
}

}  // namespace
}  // namespace wiimote_tracker::import
