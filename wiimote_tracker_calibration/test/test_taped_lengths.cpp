// Lengths between the corners by tape, as observations of a solution.
#include "measure_trial.h"
#include "wave_trial.h"
#include "wiimote_tracker_calibration/simulation/simulated_wave.h"

#include "samples/next_measurement.h"
#include "samples/solve_samples.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace wiimote_tracker::samples {
namespace {

/// RMS error of the six lengths between the corners, as a solver placed them [m].
double lengthError(const wave::SimulatedWave& truth, const square::Corners& offsets) {
  const square::Corners nominal = truth.recording.square->corners(true);
  double sum = 0.0;
  for (std::size_t from = 0; from < 4; ++from) {
    for (std::size_t to = from + 1; to < 4; ++to) {
      const double solved = (nominal[to] + offsets[to] - nominal[from] - offsets[from]).norm();
      sum += std::pow(solved - (truth.corners[to] - truth.corners[from]).norm(), 2) / 6.0;
    }
  }
  return std::sqrt(sum);
}

class TapedLengths : public ::testing::Test {
 protected:
  TapedLengths() {
    scene_.uncertainty = square::Uncertainty();
    scene_.uncertainty.placement = 0.02;
    scene_.duration = 4.0;
    scene_.rate = 50.0;
    scene_.camera_count = 3;
    simulated_ = wave::simulateWave(scene_, 11);
    taped_ = simulated_.recording;
    std::mt19937_64 random(1);
    std::normal_distribution<double> noise(0.0, 0.001);
    for (std::size_t from = 0; from < 4; ++from) {
      for (std::size_t to = from + 1; to < 4; ++to)
        taped_.square->lengths.push_back(
            {from, to, (simulated_.corners[to] - simulated_.corners[from]).norm() + noise(random)});
    }
  }

  std::mt19937_64 random_;  // before the path that draws from it
  wave::WaveScene scene_;
  wave::SimulatedWave simulated_{{}, {}, {}, {}, wave::SimulatedPath(0.0, random_), {}, {}};
  wave::Recording taped_;
};

TEST_F(TapedLengths, PlaceTheCornersOfASquare) {
  square::SolveOptions options;
  options.uncertainty = scene_.uncertainty;
  const auto sightings = taped_.sightings();
  const auto without = square::solveSquare(*simulated_.recording.square, sightings, options);
  const auto with = square::solveSquare(*taped_.square, sightings, options);
  EXPECT_GT(lengthError(simulated_, without.corner_offsets), 0.003);
  EXPECT_LT(lengthError(simulated_, with.corner_offsets), 0.001);
  EXPECT_LT(with.expected_error, 0.9 * without.expected_error);
  EXPECT_LT(with.misfit, 1.5);
}

TEST_F(TapedLengths, PlaceTheCornersOfAWave) {
  const wave::WaveOptions options = wave::optionsFor(scene_);
  const auto without = wave::solveWave(simulated_.recording, options);
  const auto with = wave::solveWave(taped_, options);
  EXPECT_GT(lengthError(simulated_, without.corner_offsets), 0.003);
  EXPECT_LT(lengthError(simulated_, with.corner_offsets), 0.001);
  EXPECT_LT(with.expected_error, 0.9 * without.expected_error);
  EXPECT_LT(with.misfit, 1.5);
}

class NextMeasurementOf : public ::testing::Test {
 protected:
  NextMeasurementOf() {
    scene_.uncertainty = square::Uncertainty();
    scene_.duration = 6.0;
    scene_.rate = 50.0;
    scene_.camera_count = 3;
  }
  wave::WaveScene scene_;
};

TEST_F(NextMeasurementOf, AWaveKeepsItsPromise) {
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    const auto steps = runMeasureTrial(scene_, seed, 3);
    ASSERT_EQ(steps.size(), 4U);
    EXPECT_EQ(steps[0].next->text.rfind("put the LED on a place you know, near (", 0), 0U)
        << steps[0].next->text;
    for (std::size_t k = 0; k + 1 < steps.size(); ++k) {
      EXPECT_LT(steps[k].next->expected_error, 0.95 * steps[k].expected);
      EXPECT_NEAR(steps[k + 1].expected / steps[k].next->expected_error, 1.0, 0.05);
    }
    EXPECT_LT(steps[3].expected, 0.5 * steps[0].expected);
    EXPECT_LT(steps[3].error, 0.006);
  }
}

TEST_F(NextMeasurementOf, IsNoneWhereNoneGains) {
  const wave::SimulatedWave simulated = wave::simulateWave(scene_, 1);
  const square::Solution solution = wave::solveWave(simulated.recording, wave::optionsFor(scene_));
  const auto next = [&](double scale) {
    square::Solution scaled = solution;
    scaled.joint_covariance *= scale;
    return nextMeasurement(scaled, simulated.recording.square.value(),
                           {{0.0, 0.0, 2.0}, {2.5, 2.5, 2.0}}, 0.2);
  };
  EXPECT_TRUE(next(1.0));
  EXPECT_FALSE(next(1e-4));
}

}  // namespace
}  // namespace wiimote_tracker::samples
