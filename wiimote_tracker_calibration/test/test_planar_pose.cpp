// The pose of a square in one image. All simulated.

#include "square/planar_pose.h"

#include "pose_trial.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <limits>
#include <utility>

namespace wiimote_tracker::square {
namespace {

constexpr double kOneDegree = M_PI / 180.0;

geometry::Intrinsics distortingLens() {
  geometry::Intrinsics lens;
  lens.distortion = {-0.12, 0.03, 0.001, -0.002, 0.0};
  return lens;
}

geometry::Intrinsics wideLens() {
  geometry::Intrinsics lens;
  lens.distortion_model = geometry::DistortionModel::kEquidistant;
  lens.fx = lens.fy = 500.0;
  lens.distortion = {0.02, -0.01, 0.0, 0.0, 0.0};
  return lens;
}

struct PoseSetup {
  geometry::Intrinsics lens;
  int poses;  // per tilt bin
};

class Lenses : public ::testing::TestWithParam<PoseSetup> {};

TEST_P(Lenses, AnyRectangleWithoutNoiseGivesTheExactPose) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int i = 0; i < 300; ++i) {
    // Straight from above is among them.
    PoseTrial trial =
        drawPoseTrial(random, GetParam().lens, 0.0, i % 10 == 0 ? 0.0 : 75.0 * kOneDegree);
    // Another rectangle, of either direction, anywhere in a plane of any height.
    const double stretch = 1.0 + 0.2 * uniform(random);
    const Eigen::Vector3d shift(uniform(random), uniform(random), 0.3 * uniform(random));
    for (std::size_t c = 0; c < 4; ++c)
      trial.corners[c].x() *= stretch;
    if (i % 2 == 0)
      std::swap(trial.corners[1], trial.corners[3]);
    for (std::size_t c = 0; c < 4; ++c) {
      trial.pixels[c] = trial.truth.project(trial.corners[c]).value();
      trial.corners[c] += shift;
    }
    trial.truth.world_from_camera.pretranslate(shift);
    const PlanarPoses found = planarPoses(GetParam().lens, trial.pixels, trial.corners);
    ASSERT_FALSE(found.empty());
    EXPECT_LT(found[0].cost, 1e-12);
    const Eigen::Isometry3d error =
        trial.truth.world_from_camera.inverse() * found[0].world_from_camera;
    EXPECT_LT(error.translation().norm(), 1e-6) << i;
    EXPECT_LT((error.linear() - Eigen::Matrix3d::Identity()).norm(), 1e-6) << i;
    EXPECT_LT(
        (found[0].world_from_camera.linear() * found[0].world_from_camera.linear().transpose() -
         Eigen::Matrix3d::Identity())
            .norm(),
        1e-12);
  }
}

TEST_P(Lenses, ExtensiveRunsAreAsGoodAsManyStartsAndReachTheBound) {
  for (int bin = 0; bin < 5; ++bin) {
    std::mt19937_64 random(static_cast<std::uint64_t>(bin + 1));
    PoseTally tally;
    for (int i = 0; i < GetParam().poses; ++i) {
      const PoseTrial trial = drawPoseTrial(random, GetParam().lens, 15.0 * bin * kOneDegree,
                                            15.0 * (bin + 1) * kOneDegree);
      tally.add(trial, planarPoses(GetParam().lens, trial.pixels, trial.corners),
                multiStartPoses(trial, 2, random));
    }
    std::cout << "tilt " << 15 * bin << " to " << 15 * bin + 15 << " degrees: whitened "
              << tally.whitened() << " of " << tally.judged << ", worst excess "
              << tally.worst_excess << ", on the wrong branch " << tally.wrong << " and "
              << tally.wrong_multi_start << '\n';
    // Fewer scatter too much: 0.9 % at 1000 poses.
    if (GetParam().poses >= 1000) {
      EXPECT_GT(tally.judged, 500);
      EXPECT_LE(tally.whitened(), 1.02);
    }
    EXPECT_LE(tally.worst_excess, 1e-6);
    EXPECT_LE(tally.wrong, 1.05 * tally.wrong_multi_start);
    EXPECT_EQ(tally.missed, 0);
  }
}

INSTANTIATE_TEST_SUITE_P(PinholeDistortedWide,
                         Lenses,
                         ::testing::Values(PoseSetup{geometry::Intrinsics(), 1000},
                                           PoseSetup{distortingLens(), 150},
                                           PoseSetup{wideLens(), 150}));

TEST(PlanarPose, BothBranchesAreFoundBestFirstAndTheirCostsAreReprojectionErrors) {
  std::mt19937_64 random(5);
  int two = 0;
  for (int i = 0; i < 200; ++i) {
    const PoseTrial trial =
        drawPoseTrial(random, geometry::Intrinsics(), 20.0 * kOneDegree, 75.0 * kOneDegree);
    const PlanarPoses found = planarPoses(trial.truth.intrinsics, trial.pixels, trial.corners);
    two += found.size() == 2;
    for (const PlanarPose& pose : found) {
      geometry::Camera camera = trial.truth;
      camera.world_from_camera = pose.world_from_camera;
      double cost = 0.0;
      for (std::size_t c = 0; c < 4; ++c)
        cost += (camera.project(trial.corners[c]).value() - trial.pixels[c]).squaredNorm();
      EXPECT_NEAR(pose.cost, cost, 1e-9 * (1.0 + cost));
      EXPECT_GE(pose.cost, found[0].cost);
      // A plane's visible side cannot be mistaken.
      EXPECT_GT(camera.center().z(), 0.0);
    }
  }
  EXPECT_GT(two, 150);
}

TEST(PlanarPose, PixelsThatNoRectangleCanHaveGiveNone) {
  const Corners corners = {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, 0, 0),
                           Eigen::Vector3d(1, 1, 0), Eigen::Vector3d(0, 1, 0)};
  const geometry::Intrinsics lens;
  const auto at = [](double u, double v) { return Eigen::Vector2d(u, v); };
  EXPECT_TRUE(
      planarPoses(lens, {at(0, 0), at(100, 100), at(200, 200), at(300, 300)}, corners).empty());
  EXPECT_TRUE(planarPoses(lens, {at(50, 50), at(50, 50), at(50, 50), at(50, 50)}, corners).empty());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(
      planarPoses(lens, {at(nan, 50), at(90, 50), at(90, 90), at(50, 90)}, corners).empty());
  EXPECT_TRUE(
      planarPoses(lens, {at(100, 100), at(200, 100), at(300, 100), at(200, 300)}, corners).empty());
  // One inside the others, crossing sides: whatever comes out is finite.
  for (const std::array<Eigen::Vector2d, 4>& pixels :
       {std::array<Eigen::Vector2d, 4>{at(100, 100), at(500, 100), at(300, 200), at(300, 500)},
        std::array<Eigen::Vector2d, 4>{at(100, 100), at(500, 500), at(500, 100), at(100, 500)}}) {
    for (const PlanarPose& pose : planarPoses(lens, pixels, corners)) {
      EXPECT_TRUE(pose.world_from_camera.matrix().allFinite());
      EXPECT_TRUE(std::isfinite(pose.cost));
    }
  }
}

}  // namespace
}  // namespace wiimote_tracker::square
