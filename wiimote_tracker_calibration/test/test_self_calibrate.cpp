#include "bundle_synthetic_rig.h"
#include "expect_says.h"
#include "refusal_of.h"

#include "../src/bundle/steps.h"

#include "wiimote_tracker_calibration/bundle/self_calibrate.h"
#include "wiimote_tracker_calibration/bundle/similarity.h"
#include "wiimote_tracker_calibration/bundle/statistics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace wiimote_tracker::bundle {
namespace {

/// Square pixels, and focal lengths that differ from camera to camera.
SyntheticRig rigOf(std::size_t camera_count, std::size_t point_count, unsigned seed) {
  SyntheticRig rig(camera_count, point_count, seed);
  for (geometry::Camera& camera : rig.cameras) {
    geometry::Intrinsics& lens = camera.intrinsics;
    lens.fx = rig.uniform(400.0, 560.0);
    lens.fy = lens.fx * rig.uniform(0.997, 1.003);
  }
  rig.observe();
  return rig;
}

SelfCalibration solved(const SyntheticRig& rig, const SelfCalibrationOptions& options = {}) {
  return selfCalibrate(rig.observed(), options);
}

std::string refusal(const SyntheticRig& rig, const SelfCalibrationOptions& options = {}) {
  return refusalOf([&] { solved(rig, options); });
}

/// RMS distance of the points from the truth after the best similarity [m].
double shapeError(const SyntheticRig& rig, const SelfCalibration& result) {
  const auto [from, to] = rig.paired(result.reconstruction);
  EXPECT_GT(from.size(), rig.points.size() / 2);
  const Eigen::Affine3d similarity = fitSimilarity(from, to);
  double squares = 0.0;
  for (std::size_t i = 0; i < from.size(); ++i)
    squares += (similarity * from[i] - to[i]).squaredNorm();
  return std::sqrt(squares / static_cast<double>(from.size()));
}

TEST(SelfCalibrate, FindsLensesPosesAndPointsFromPixelsAlone) {
  for (const std::size_t camera_count : {3u, 4u}) {
    SCOPED_TRACE(std::to_string(camera_count) + " cameras");
    SyntheticRig rig = rigOf(camera_count, 120, 21);
    rig.addNoise(0.3);
    const SelfCalibration result = solved(rig);
    EXPECT_EQ(result.agreeing, result.followed);
    EXPECT_NEAR(result.pixel_stddev, 0.3, 0.03);
    for (std::size_t i = 0; i < camera_count; ++i) {
      const LensCertainty& lens = result.lenses[i];
      EXPECT_TRUE(lens.focal_determined);
      EXPECT_NEAR(result.reconstruction.cameras[i].intrinsics.fx, rig.cameras[i].intrinsics.fx,
                  4.0 * lens.focal_stddev);
      EXPECT_LT(lens.focal_stddev, 20.0);
    }
    EXPECT_LT(shapeError(rig, result), 0.02);
  }
}

TEST(SelfCalibrate, GrossErrorsAreFoundAndDoNoHarm) {
  SyntheticRig rig = rigOf(4, 100, 22);
  rig.addNoise(0.2);
  std::vector<bool> spoiled(rig.observations.size(), false);
  std::vector<std::size_t> views(rig.points.size(), 0);
  for (std::size_t i = 0; i < rig.observations.size(); ++i) {
    ++views[rig.observations[i].point];
    if (i % 17 != 0)
      continue;
    rig.observations[i].pixel = {rig.uniform(0.0, 659.0), rig.uniform(0.0, 499.0)};
    spoiled[i] = true;
  }
  const SelfCalibration result = solved(rig);
  std::size_t judged = 0;
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < rig.observations.size(); ++i) {
    if (views[rig.observations[i].point] < 4)
      continue;  // fewer may agree on a wrong place
    ++judged;
    wrong += result.reconstruction.inliers[i] == spoiled[i] ? 1 : 0;
  }
  EXPECT_GT(judged, 300u);
  EXPECT_LE(wrong, 2u);  // a random pixel may happen to be right
  EXPECT_LT(shapeError(rig, result), 0.02);
}

TEST(SelfCalibrate, CamerasWithOneLensAreSolvedWithOne) {
  SyntheticRig rig = rigOf(4, 100, 23);
  for (geometry::Camera& camera : rig.cameras)
    camera.intrinsics = rig.cameras.front().intrinsics;
  rig.observe();
  rig.addNoise(0.3);
  SelfCalibrationOptions options;
  options.bundle.one_lens = true;
  const SelfCalibration result = solved(rig, options);
  for (const geometry::Camera& camera : result.reconstruction.cameras) {
    EXPECT_EQ(camera.intrinsics.fx, result.reconstruction.cameras.front().intrinsics.fx);
    EXPECT_NEAR(camera.intrinsics.fx, rig.cameras.front().intrinsics.fx,
                4.0 * result.lenses.front().focal_stddev);
  }
  EXPECT_LT(result.lenses.front().focal_stddev, solved(rig).lenses.front().focal_stddev);
}

TEST(SelfCalibrate, SaysThatParallelCamerasDoNotDetermineFocalLengths) {
  SyntheticRig rig = rigOf(2, 120, 24);
  for (std::size_t i = 0; i < 2; ++i)
    rig.cameras[i].world_from_camera = geometry::lookAt(
        {4.0, static_cast<double>(i), 1.0}, {0.0, static_cast<double>(i), 1.0}, {0.0, 0.0, 1.0});
  rig.observe();
  rig.addNoise(0.2);
  const SelfCalibration result = solved(rig);
  EXPECT_LT(statistics(result.reconstruction).rms, 0.4);
  EXPECT_FALSE(result.lenses[0].focal_determined);
  EXPECT_FALSE(result.lenses[1].focal_determined);

  SelfCalibrationOptions given;
  given.bundle.fixed_lenses = true;
  const SelfCalibration fixed = solved(rig, given);
  EXPECT_TRUE(fixed.lenses[0].focal_determined);
  EXPECT_LT(shapeError(rig, fixed), 0.02);
}

TEST(SelfCalibrate, TellsTheNoiseWhenTheLensesAreGiven) {
  // Few points: degrees of freedom for lenses that are not fitted would enlarge it by 15 % or more.
  SelfCalibrationOptions given;
  given.bundle.fixed_lenses = true;
  const int kRuns = 10;
  for (const double noise : {0.3, 1.0}) {  // much below the scale of the Huber loss, and as large
    double squares = 0.0;
    for (unsigned run = 0; run < kRuns; ++run) {
      SyntheticRig rig = rigOf(3, 40, 100 + run);
      rig.addNoise(noise);
      squares += std::pow(solved(rig, given).pixel_stddev, 2);
    }
    EXPECT_NEAR(std::sqrt(squares / kRuns), noise, 0.1 * noise);
  }
}

class StatedUncertainty : public ::testing::TestWithParam<double> {};

TEST_P(StatedUncertainty, IsThatOfTheErrors) {
  // From the truth on, nothing else known, so that only the noise matters. Chi-square of 4 focal
  // lengths, 30 times: its mean is 1 with a standard deviation of 0.13 were they independent, at
  // most 0.26.
  SyntheticRig exact = rigOf(4, 80, 25);
  const int kRuns = 30;
  double sum = 0.0;
  double squares = 0.0;
  double expected = 0.0;
  double ratio = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    SyntheticRig rig = exact;
    rig.random.seed(static_cast<unsigned>(100 + run));
    rig.addNoise(0.05);
    SelfCalibration result;
    Reconstruction& solution = result.reconstruction;
    solution.cameras = rig.cameras;
    solution.observations = rig.observations;
    solution.inliers.assign(rig.observations.size(), true);
    solution.points.assign(rig.points.begin(), rig.points.end());
    std::vector<std::size_t> views(rig.points.size(), 0);
    for (const Observation& observation : rig.observations)
      ++views[observation.point];
    for (std::size_t i = 0; i < rig.observations.size(); ++i)
      solution.inliers[i] = views[rig.observations[i].point] >= 2;
    for (std::size_t i = 0; i < rig.points.size(); ++i) {
      if (views[i] < 2)
        solution.points[i].reset();
    }
    Options options;
    options.loss_scale = GetParam();
    options.pixel_stddev = 0.05;
    options.lens.aspect = 1.0;
    options.lens.principal_point = 10.0;
    options.lens.distortion = {10.0, 10.0, 10.0, 10.0, 1e-6};
    options.fixed_lenses = false;
    adjust(&solution, options);
    Certainty certainty(solution, options);
    for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
      const auto covariance = certainty.lensCovariance(i);
      ASSERT_TRUE(covariance);
      sum += std::pow(solution.cameras[i].intrinsics.fx - exact.cameras[i].intrinsics.fx, 2) /
             (*covariance)(0, 0);
    }
    squares += std::pow(shapeError(exact, result), 2);
    expected += std::pow(certainty.expectedShapeError().value(), 2);
    ratio += birgeRatio(solution, options) / kRuns;
  }
  EXPECT_NEAR(sum / (4.0 * kRuns), 1.0, 0.4);
  EXPECT_NEAR(std::sqrt(squares / expected), 1.0, 0.15);
  // It is never below 1.
  EXPECT_LT(ratio, 1.1);
}

// Least squares, and a loss that is linear for most of the residuals, of 0.05 px a coordinate [px].
INSTANTIATE_TEST_SUITE_P(HuberScales, StatedUncertainty, ::testing::Values(100.0, 0.03));

/// Sum of the squared errors of the focal lengths over their stated variances.
double chiSquared(const SyntheticRig& rig) {
  const SelfCalibration result = solved(rig);
  double sum = 0.0;
  for (std::size_t i = 0; i < rig.cameras.size(); ++i)
    sum +=
        std::pow((result.reconstruction.cameras[i].intrinsics.fx - rig.cameras[i].intrinsics.fx) /
                     result.lenses[i].focal_stddev,
                 2);
  return sum;
}

TEST(ExtensiveSelfCalibrate, StatesErrorsThatTheLensModelDoesNotExplain) {
  double sum = 0.0;
  double count = 0.0;
  for (const unsigned seed : {1U, 2U, 3U}) {
    SyntheticRig rig = rigOf(4, 120, seed);
    rig.addNoise(0.2);
    for (Observation& observation : rig.observations) {
      const Eigen::Vector2d at = 0.02 * observation.pixel;
      const auto camera = static_cast<double>(observation.camera);
      observation.pixel += 0.4 * Eigen::Vector2d(std::sin(at.x() + 0.65 * at.y() + camera),
                                                 std::cos(at.y() - 0.55 * at.x() + 2.0 * camera));
    }
    sum += chiSquared(rig);
    count += 4.0;
  }
  std::cout << "lenses with unmodelled terms: chi-squared " << sum / count << " per focal length\n";
  EXPECT_GT(sum / count, 0.7);
  EXPECT_LT(sum / count, 1.5);
}

TEST(ExtensiveSelfCalibrate, StatesErrorsOfResidualsThatAreCorrelatedInTime) {
  double sum = 0.0;
  const unsigned kRuns = 6;
  for (unsigned seed = 1; seed <= kRuns; ++seed) {
    SyntheticRig rig = rigOf(4, 200, seed);
    for (std::size_t i = 0; i < rig.points.size(); ++i) {
      const double time = 0.1 * static_cast<double>(i);
      rig.points[i] = {1.2 * std::sin(0.9 * time), 1.2 * std::sin(0.7 * time + seed),
                       1.0 + 0.8 * std::sin(1.3 * time)};
    }
    rig.observe();
    rig.addNoise(0.1);
    // A first-order Gauss-Markov process with a correlation time of ten points.
    const double kKept = std::exp(-0.1);
    std::normal_distribution<double> step(0.0, 0.3 * std::sqrt(1.0 - kKept * kKept));
    std::vector<Eigen::Vector2d> errors(rig.cameras.size(), Eigen::Vector2d::Zero());
    for (Observation& observation : rig.observations) {
      Eigen::Vector2d& error = errors[observation.camera];
      error = kKept * error + Eigen::Vector2d(step(rig.random), step(rig.random));
      observation.pixel += error;
    }
    sum += chiSquared(rig);
  }
  const double mean = sum / (4.0 * kRuns);
  std::cout << "residuals correlated in time: chi-squared " << mean << " per focal length\n";
  EXPECT_GT(mean, 0.7);
  EXPECT_LT(mean, 1.5);
}

TEST(SelfCalibrate, NamesAMirroredImage) {
  SyntheticRig rig = rigOf(3, 80, 26);
  rig.addNoise(0.2);
  for (Observation& observation : rig.observations) {
    if (observation.camera == 1)
      observation.pixel.x() = 659.0 - observation.pixel.x();
  }
  EXPECT_SAYS(refusal(rig), "the image of camera_2 is mirrored");
}

TEST(SelfCalibrate, NamesCrossedIntrinsics) {
  SyntheticRig rig = rigOf(3, 80, 27);
  rig.cameras[2].intrinsics.fx *= 2.5;
  rig.cameras[2].intrinsics.fy *= 2.5;
  rig.observe();
  rig.addNoise(0.2);
  std::swap(rig.cameras[0].intrinsics, rig.cameras[2].intrinsics);
  SelfCalibrationOptions options;
  options.bundle.fixed_lenses = true;
  EXPECT_SAYS(refusal(rig, options), "intrinsics of camera_1 and camera_3 are crossed");
}

TEST(SelfCalibrate, RefusesWhatContradictsItself) {
  SyntheticRig rig = rigOf(3, 60, 28);
  for (Observation& observation : rig.observations) {
    if (observation.camera == 2)
      observation.pixel = {rig.uniform(0.0, 659.0), rig.uniform(0.0, 499.0)};
  }
  EXPECT_SAYS(refusal(rig), "camera_3");
}

TEST(SelfCalibrate, RefusesALine) {
  SyntheticRig rig = rigOf(3, 80, 29);
  for (geometry::Camera& camera : rig.cameras)
    camera.intrinsics.distortion = {};
  for (std::size_t i = 0; i < rig.points.size(); ++i)
    rig.points[i] = Eigen::Vector3d(-1.0, -0.5, 0.4) +
                    static_cast<double>(i) / 80.0 * Eigen::Vector3d(2.0, 1.0, 1.0);
  rig.observe();
  EXPECT_SAYS(refusal(rig), "moved on a line only");
}

TEST(SelfCalibrate, RefusesAPlane) {
  SyntheticRig rig = rigOf(3, 100, 30);
  for (Eigen::Vector3d& point : rig.points)
    point.z() = 0.5 + 0.2 * point.x();
  rig.observe();
  rig.addNoise(0.2);
  EXPECT_SAYS(refusal(rig), "in one plane only");
}

TEST(SelfCalibrate, RefusesTooFew) {
  EXPECT_SAYS(refusal(rigOf(3, 8, 31)), "10 points in common");
  SyntheticRig one = rigOf(3, 50, 31);
  one.cameras.resize(1);
  one.observe();
  EXPECT_SAYS(refusal(one), "two cameras or more");
}

TEST(SelfCalibrate, ReportsItsProgress) {
  const SyntheticRig rig = rigOf(3, 60, 32);
  double last = 0.0;
  selfCalibrate(rig.observed(), {}, [&](const std::string&, double fraction) {
    EXPECT_GE(fraction, last);
    last = fraction;
  });
  EXPECT_GE(last, 0.9);
}

}  // namespace
}  // namespace wiimote_tracker::bundle
