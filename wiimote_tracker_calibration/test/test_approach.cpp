// A rig that is replaced in small steps: points at rest hardly move by any of them.

#include "misled_trial.h"
#include "waved_led.h"

#include "continuous/approach.h"

#include <gtest/gtest.h>
#include <wiimote_tracker_triangulation/geometry/camera_parameters.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace wiimote_tracker::continuous {
namespace {

using square::Random;

/// Corners and middle of a cube in front of the cameras [m].
std::vector<Eigen::Vector3d> cube() {
  std::vector<Eigen::Vector3d> places = {{1.25, 1.25, 1.25}};
  for (const double z : {0.5, 2.0}) {
    for (const double y : {0.5, 2.0}) {
      for (const double x : {0.5, 2.0})
        places.emplace_back(x, y, z);
    }
  }
  return places;
}

/// All cameras turned, with other lenses and clocks.
geometry::Rig changed(geometry::Rig rig, double angle, Random& random) {
  for (geometry::RigCamera& camera : rig.cameras) {
    camera = turned(camera, angle, random);
    camera.camera.intrinsics.fx += 1.0;
    camera.camera.intrinsics.distortion[0] += 0.001;
    camera.time_offset += 0.002;
  }
  return rig;
}

/// How far a place seems to move that all cameras see: to the point of least squared distance from
/// their rays [m].
double independentMovement(const geometry::Rig& from,
                           const geometry::Rig& to,
                           const Eigen::Vector3d& place) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < from.cameras.size(); ++i) {
    const geometry::Camera& camera = to.cameras[i].camera;
    const auto pixel = from.cameras[i].camera.project(place);
    const Eigen::Vector3d direction = (camera.world_from_camera.linear() *
                                       camera.intrinsics.normalizedFromPixel(*pixel)->homogeneous())
                                          .normalized();
    const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - direction * direction.transpose();
    normal += across;
    right += across * camera.center();
  }
  return (normal.inverse() * right - place).norm();
}

TEST(Approach, MovesPointsAtRestALittleAtATimeUntilTheGoal) {
  Random random(1);
  const geometry::Rig start = paperRigWith(wellCalibrated());
  const geometry::Rig goal = changed(start, 0.001, random);
  const std::vector<Eigen::Vector3d> places = cube();
  double way = 0.0;
  for (const Eigen::Vector3d& place : places)
    way = std::max(way, independentMovement(start, goal, place));
  ASSERT_GT(way, 0.001);

  Approach approach(goal, places);
  geometry::Rig rig = start;
  int steps = 0;
  for (double stamp = 1000.0; !approach.isReached() && steps < 100; stamp += Approach::kPeriod) {
    const auto next = approach.step(rig, stamp);
    ASSERT_TRUE(next);
    EXPECT_FALSE(approach.step(*next, stamp + 0.9 * Approach::kPeriod)) << "too early";
    for (const Eigen::Vector3d& place : places)
      EXPECT_LT(independentMovement(rig, *next, place), 1.2 * Approach::kLongestStep);
    rig = *next;
    ++steps;
  }
  EXPECT_EQ(goal.id(), rig.id());
  EXPECT_LT(steps, 2.0 * way / Approach::kLongestStep);
  EXPECT_FALSE(approach.step(rig, 1e6)) << "there is nothing left";
}

TEST(Approach, UsesNewClocksAtOnceAndStatesWhatIsLeft) {
  Random random(2);
  const geometry::Rig start = paperRigWith(wellCalibrated());
  const geometry::Rig goal = changed(start, 0.001, random);
  const geometry::Rig rig = between(start, goal, 0.25);
  for (std::size_t i = 0; i < goal.cameras.size(); ++i) {
    EXPECT_EQ(goal.cameras[i].time_offset, rig.cameras[i].time_offset);
    const geometry::Camera& from = start.cameras[i].camera;
    const geometry::Camera& to = goal.cameras[i].camera;
    const geometry::Camera& camera = rig.cameras[i].camera;
    const Eigen::Quaterniond half =
        Eigen::Quaterniond(from.world_from_camera.linear())
            .slerp(0.25, Eigen::Quaterniond(to.world_from_camera.linear()));
    EXPECT_LT(half.angularDistance(Eigen::Quaterniond(camera.world_from_camera.linear())), 1e-9);
    EXPECT_NEAR(from.intrinsics.fx + 0.25, camera.intrinsics.fx, 1e-9);
    // The variance of a position or an angle: the goal's, and the square of what is left.
    const Eigen::Index fx = geometry::firstParameter(i) + geometry::kIntrinsics;
    EXPECT_NEAR(goal.covariance(fx, fx) + 0.75 * 0.75, rig.covariance(fx, fx), 1e-9);
    const Eigen::Index first = geometry::firstParameter(i);
    EXPECT_NEAR(goal.covariance.diagonal().segment<3>(first).sum() + std::pow(0.75 * 0.001, 2),
                rig.covariance.diagonal().segment<3>(first).sum(), 1e-12);
  }
}

TEST(Approach, OnlyAKnockedCameraIsChangedAtOnce) {
  Random random(3);
  const geometry::Rig start = paperRigWith(wellCalibrated());
  const geometry::Rig goal = changed(start, 0.001, random);
  Approach approach(goal, cube());
  const geometry::Rig before = *approach.step(start, 1000.0);
  geometry::Rig other = goal;
  other.cameras[1] = turned(other.cameras[1], 0.03, random);
  geometry::Rig rig = approach.changeGoal(other, {other.cameras[1].camera.name}, before);
  const auto pose = [](const geometry::Rig& of, std::size_t camera) {
    return of.cameras[camera].camera.world_from_camera.matrix();
  };
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_LT((pose(rig, i) - pose(i == 1 ? other : before, i)).norm(), 1e-9) << i;
  EXPECT_FALSE(approach.step(rig, 1000.0 + 0.9 * Approach::kPeriod)) << "too early";
  for (double stamp = 1030.0; !approach.isReached() && stamp < 4000.0; stamp += Approach::kPeriod) {
    const geometry::Rig next = *approach.step(rig, stamp);
    EXPECT_LE(movementOf(rig, next, cube()), 1.2 * Approach::kLongestStep);
    rig = next;
  }
  EXPECT_EQ(rig.id(), other.id());
}

}  // namespace
}  // namespace wiimote_tracker::continuous
