#include "bundle_synthetic_rig.h"
#include "expect_says.h"
#include "refusal_of.h"

#include "wiimote_tracker_calibration/bundle/similarity.h"
#include "wiimote_tracker_calibration/bundle/solve.h"
#include "wiimote_tracker_calibration/bundle/statistics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>

namespace wiimote_tracker::bundle {
namespace {

std::vector<Eigen::Vector3d> centers(const std::vector<geometry::Camera>& cameras) {
  std::vector<Eigen::Vector3d> result;
  for (const geometry::Camera& camera : cameras)
    result.push_back(camera.center());
  return result;
}

/// Brings the solution into the frame of the truth, over the points.
void align(const SyntheticRig& rig, Reconstruction* solution) {
  const auto [solved, truth] = rig.paired(*solution);
  transform(fitSimilarity(solved, truth), solution);
}

std::string refusal(const Reconstruction& observed) {
  return refusalOf([&] { solve(observed, Options()); });
}

TEST(Bundle, RecoversARigFromExactPixels) {
  for (const std::size_t camera_count : {2u, 3u, 4u, 8u}) {
    for (unsigned seed = 1; seed <= 3; ++seed) {
      SCOPED_TRACE(std::to_string(camera_count) + " cameras, seed " + std::to_string(seed));
      const SyntheticRig rig(camera_count, 120, seed);
      Reconstruction solution = solve(rig.observed(), Options());
      align(rig, &solution);
      for (std::size_t i = 0; i < camera_count; ++i) {
        EXPECT_TRUE(
            solution.cameras[i].world_from_camera.isApprox(rig.cameras[i].world_from_camera, 1e-7));
      }
      const auto [determined, truth] = rig.paired(solution);
      for (std::size_t i = 0; i < determined.size(); ++i)
        EXPECT_LT((determined[i] - truth[i]).norm(), 1e-6);
      EXPECT_GT(determined.size(), 60u);
    }
  }
}

TEST(Bundle, SolvesWithWideAngleLenses) {
  SyntheticRig rig(3, 100, 4);
  for (geometry::Camera& camera : rig.cameras) {
    camera.intrinsics.distortion_model = geometry::DistortionModel::kEquidistant;
    camera.intrinsics.distortion = {-0.05, 0.01, 0.002, -0.001, 0.0};
  }
  rig.observe();
  Reconstruction solution = solve(rig.observed(), Options());
  align(rig, &solution);
  for (std::size_t i = 0; i < rig.cameras.size(); ++i)
    EXPECT_TRUE(
        solution.cameras[i].world_from_camera.isApprox(rig.cameras[i].world_from_camera, 1e-7));
}

TEST(Bundle, ResidualsAreAsLargeAsTheNoise) {
  const double kNoise = 0.4;  // px
  const SyntheticRig exact(4, 400, 5);
  SyntheticRig rig = exact;
  rig.addNoise(kNoise);
  const Reconstruction solution = solve(rig.observed(), Options());
  const Statistics all = statistics(solution);
  // Expected sum of squares: noise variance times (measured numbers - unknowns), Gauss-Markov.
  std::size_t points = 0;
  for (const auto& point : solution.points)
    points += point ? 1 : 0;
  const double measured = 2.0 * static_cast<double>(all.inliers);
  const double unknowns = 3.0 * static_cast<double>(points) + 6.0 * 4.0 - 7.0;
  const double expected =
      kNoise * std::sqrt((measured - unknowns) / static_cast<double>(all.inliers));
  // The standard deviation of this estimate is about 1.5 % for so many observations.
  EXPECT_NEAR(all.rms / expected, 1.0, 0.05);
  EXPECT_LT(all.median, all.rms);
  EXPECT_GT(all.inliers, all.observations * 99 / 100);
}

TEST(Bundle, GrossErrorsAreFoundAndDoNoHarm) {
  SyntheticRig rig(4, 300, 6);
  rig.addNoise(0.2);
  std::vector<bool> spoiled(rig.observations.size(), false);
  for (std::size_t i = 0; i < rig.observations.size(); i += 37) {
    rig.observations[i].pixel += Eigen::Vector2d(rig.uniform(40.0, 90.0), rig.uniform(40.0, 90.0));
    spoiled[i] = true;
  }
  Reconstruction solution = solve(rig.observed(), Options());
  std::vector<std::size_t> views(rig.points.size(), 0);
  for (const Observation& observation : rig.observations)
    ++views[observation.point];
  for (std::size_t i = 0; i < rig.observations.size(); ++i) {
    if (views[rig.observations[i].point] >= 3) {  // two alone may agree on a wrong place
      EXPECT_EQ(solution.inliers[i], !spoiled[i]) << "observation " << i;
    }
  }
  align(rig, &solution);
  for (std::size_t i = 0; i < rig.cameras.size(); ++i)
    EXPECT_LT((solution.cameras[i].center() - rig.cameras[i].center()).norm(), 0.01);
}

TEST(Bundle, IsDeterministic) {
  SyntheticRig rig(3, 100, 7);
  rig.addNoise(0.3);
  const Reconstruction a = solve(rig.observed(), Options());
  const Reconstruction b = solve(rig.observed(), Options());
  for (std::size_t i = 0; i < rig.cameras.size(); ++i)
    EXPECT_EQ(a.cameras[i].world_from_camera.matrix(), b.cameras[i].world_from_camera.matrix());
}

TEST(Bundle, ACameraNeedNotShareAnythingWithTheFirst) {
  // A chain: the first and the last camera never see the same point.
  SyntheticRig rig(4, 400, 8);
  rig.addNoise(0.2);
  std::vector<Observation> chain;
  for (const Observation& observation : rig.observations) {
    const bool early = observation.point < 200;
    if ((observation.camera == 0 && !early) || (observation.camera == 3 && early))
      continue;
    chain.push_back(observation);
  }
  rig.observations = chain;
  Reconstruction solution = solve(rig.observed(), Options());
  align(rig, &solution);
  for (std::size_t i = 0; i < rig.cameras.size(); ++i)
    EXPECT_LT((solution.cameras[i].center() - rig.cameras[i].center()).norm(), 0.02);
}

TEST(Bundle, HeldPositionsStayAndOrientationsAreFound) {
  const SyntheticRig rig(4, 200, 9);
  Reconstruction start = rig.observed();
  start.cameras = rig.cameras;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> angle(-0.01, 0.01);
  for (geometry::Camera& camera : start.cameras)
    camera.world_from_camera.rotate(
        Eigen::AngleAxisd(angle(random), Eigen::Vector3d(1.0, 2.0, -1.0).normalized()));
  Options options;
  options.maximum_error = 20.0;
  options.fixed_positions = true;
  triangulatePoints(&start, options.maximum_error);
  adjust(&start, options);
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    EXPECT_EQ(start.cameras[i].center(), rig.cameras[i].center());
    EXPECT_TRUE(
        start.cameras[i].world_from_camera.isApprox(rig.cameras[i].world_from_camera, 1e-7));
  }
}

TEST(Bundle, TellsWhetherTheAdjustmentConverged) {
  // Many observations lie near this limit, so that each solution has other inliers.
  Options narrow;
  narrow.maximum_error = 1.0;
  int converged = 0;
  const int kRuns = 8;
  for (unsigned seed = 8; seed < 8 + kRuns; ++seed) {
    SyntheticRig rig(4, 300, seed);
    rig.addNoise(1.0);
    Reconstruction solution = solve(rig.observed(), Options());
    EXPECT_TRUE(solution.converged);
    triangulatePoints(&solution, narrow.maximum_error);
    adjust(&solution, narrow);
    if (!solution.converged)
      continue;
    ++converged;
    const std::vector<bool> inliers = solution.inliers;
    adjust(&solution, narrow);
    EXPECT_EQ(solution.inliers, inliers);
  }
  EXPECT_GT(converged, 0);
}

TEST(Bundle, RefusesWhatCannotBeSolved) {
  const SyntheticRig rig(3, 60, 10);
  Reconstruction alone;
  alone.cameras = {rig.cameras[0]};
  EXPECT_SAYS(refusal(alone), "two cameras or more");

  Reconstruction bad = rig.observed();
  bad.observations[4].pixel.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_SAYS(refusal(bad), "observation 4 is not finite");
  bad = rig.observed();
  bad.observations[5].camera = 3;
  EXPECT_SAYS(refusal(bad), "observation 5 names camera 3");
  bad = rig.observed();
  bad.points.resize(59);
  EXPECT_SAYS(refusal(bad), "names point 59");
}

TEST(Bundle, RefusesTooFewPoints) {
  const SyntheticRig rig(3, 7, 11);
  EXPECT_SAYS(refusal(rig.observed()), "10 or more points in common");
}

TEST(Bundle, RefusesACameraWithoutCommonPointsAndNamesIt) {
  const SyntheticRig rig(4, 200, 12);
  Reconstruction split = rig.observed();
  split.observations.clear();
  for (const Observation& observation : rig.observations) {
    // camera_3 sees only points that nobody else sees
    if ((observation.camera == 2) == (observation.point >= 150))
      split.observations.push_back(observation);
  }
  EXPECT_SAYS(refusal(split), "camera_3 shares 0 points");
}

TEST(Bundle, RefusesPointsOnALine) {
  SyntheticRig rig(3, 80, 13);
  for (std::size_t i = 0; i < rig.points.size(); ++i) {
    const double s = static_cast<double>(i) / static_cast<double>(rig.points.size());
    rig.points[i] = Eigen::Vector3d(-1.0, -0.5, 0.4) + s * Eigen::Vector3d(2.0, 1.0, 1.0);
  }
  rig.observe();
  EXPECT_SAYS(refusal(rig.observed()), "spread over the room");
}

TEST(Bundle, RefusesCamerasInOnePlace) {
  SyntheticRig rig(2, 100, 14);
  rig.cameras[1].world_from_camera = rig.cameras[0].world_from_camera;
  rig.cameras[1].world_from_camera.rotate(Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitY()));
  rig.observe();
  EXPECT_SAYS(refusal(rig.observed()), "do not stand in one place");
}

TEST(Bundle, RefusesIntrinsicsThatCannotBe) {
  const SyntheticRig rig(4, 200, 15);
  Reconstruction wrong = rig.observed();
  wrong.cameras[2].intrinsics.fx = -400.0;
  EXPECT_SAYS(refusal(wrong), "camera_3: ");
  // In range, but not this camera's: half the focal length.
  wrong = rig.observed();
  wrong.cameras[2].intrinsics.fx *= 0.5;
  EXPECT_SAYS(refusal(wrong), "camera_3");
}

TEST(BundleSimilarity, RecoversAKnownOne) {
  const Eigen::Affine3d truth =
      Eigen::Translation3d(3.0, -1.0, 0.2) *
      Eigen::AngleAxisd(1.1, Eigen::Vector3d(1.0, -2.0, 0.5).normalized()) * Eigen::Scaling(2.5);
  const SyntheticRig rig(4, 10, 16);
  const std::vector<Eigen::Vector3d> from = centers(rig.cameras);
  std::vector<Eigen::Vector3d> to;
  for (const Eigen::Vector3d& point : from)
    to.push_back(truth * point);
  const Eigen::Affine3d fitted = fitSimilarity(from, to);
  EXPECT_TRUE(fitted.linear().isApprox(truth.linear(), 1e-12));
  EXPECT_TRUE(fitted.translation().isApprox(truth.translation(), 1e-12));
}

TEST(BundleSimilarity, LeavesReprojectionsAlone) {
  SyntheticRig rig(3, 50, 17);
  rig.addNoise(1.0);
  Reconstruction reconstruction;
  reconstruction.cameras = rig.cameras;
  reconstruction.observations = rig.observations;
  for (const Eigen::Vector3d& point : rig.points)
    reconstruction.points.emplace_back(point);
  const Eigen::Affine3d similarity = Eigen::Translation3d(5.0, 6.0, 7.0) *
                                     Eigen::AngleAxisd(2.0, Eigen::Vector3d::UnitX()) *
                                     Eigen::Scaling(0.1);
  Reconstruction moved = reconstruction;
  transform(similarity, &moved);
  for (const Observation& observation : rig.observations)
    EXPECT_NEAR(*reprojectionError(reconstruction, observation),
                *reprojectionError(moved, observation), 1e-9);
}

TEST(BundleSimilarity, RefusesWhatDoesNotDetermineIt) {
  const std::vector<Eigen::Vector3d> line = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  const std::vector<Eigen::Vector3d> plane = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  EXPECT_THROW(fitSimilarity(line, plane), BundleError);
  EXPECT_THROW(fitSimilarity(plane, {line[0], line[1]}), BundleError);
  EXPECT_NO_THROW(fitSimilarity(plane, plane));
}

TEST(BundleStatistics, AreWhatTheDefinitionsSay) {
  // One camera at the origin, f = 100 px, points 2 m ahead; errors of 3, 4, 5 and 100 px.
  Reconstruction reconstruction;
  geometry::Camera camera;
  camera.intrinsics.fx = camera.intrinsics.fy = 100.0;
  camera.intrinsics.cx = camera.intrinsics.cy = 0.0;
  reconstruction.cameras.push_back(camera);
  const double errors[] = {3.0, 4.0, 5.0, 100.0};
  for (std::size_t i = 0; i < 4; ++i) {
    reconstruction.points.emplace_back(Eigen::Vector3d(0.0, 0.0, 2.0));
    reconstruction.observations.push_back({0, i, Eigen::Vector2d(0.0, errors[i])});
    reconstruction.inliers.push_back(i < 3);
  }
  const Statistics result = statistics(reconstruction, 0);
  EXPECT_EQ(result.observations, 4u);
  EXPECT_EQ(result.inliers, 3u);
  EXPECT_DOUBLE_EQ(result.mean, 4.0);
  EXPECT_DOUBLE_EQ(result.median, 4.0);
  EXPECT_DOUBLE_EQ(result.rms, std::sqrt(50.0 / 3.0));
  EXPECT_DOUBLE_EQ(result.rms_m, std::sqrt(50.0 / 3.0) * 0.02);
}

}  // namespace
}  // namespace wiimote_tracker::bundle
