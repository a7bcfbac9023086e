// Label probabilities from sightings, compared with an exhaustive computation; error rates.
#include "identity/blinking.h"
#include "identity/exhaustive_labels.h"
#include "wiimote_tracker_triangulation/identity/label_posterior.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace wiimote_tracker::identity {
namespace {

using geometry::test::Random;
using test::BlinkingOptions;
using test::fourWords;
using test::LedSighting;
using test::paperCodes;

Eigen::MatrixXd posteriorOf(const Hypotheses& hypotheses,
                            const std::vector<LedSighting>& sightings,
                            std::size_t leds,
                            double origin) {
  std::vector<Evidence> evidence(leds, Evidence(hypotheses));
  std::vector<const Evidence*> pointers;
  for (Evidence& led : evidence) {
    led.reset(origin);
    pointers.push_back(&led);
  }
  for (const LedSighting& s : sightings)
    evidence[s.led].add(s.sighting);
  return LabelPosterior(hypotheses, 0.01).compute(pointers);
}

/// Largest difference from the exhaustive probabilities in some runs. @param raster step to which
/// the times of sightings are rounded [s]; 0: not rounded.
double errorAgainstExhaustive(const BlinkingOptions& options, int runs, double raster) {
  const Hypotheses hypotheses(options.codes);
  test::ExhaustiveLabels exhaustive;
  exhaustive.codes = options.codes;
  exhaustive.memory = hypotheses.memory();
  exhaustive.exposure = options.exposure;
  exhaustive.phases = static_cast<int>(hypotheses.phases());
  exhaustive.phase_blur = 1.0 / static_cast<double>(hypotheses.phases());
  if (hypotheses.frequencies().size() > 1)
    exhaustive.phase_blur += 0.03;
  for (const double frequency : hypotheses.frequencies())
    exhaustive.periods.push_back(1.0 / frequency);
  double error = 0.0;
  for (int run = 0; run < runs; ++run) {
    Random random(static_cast<unsigned>(100 + run));
    std::vector<LedSighting> sightings = test::simulateBlinking(options, &random);
    if (raster > 0.0) {
      for (LedSighting& s : sightings)
        s.sighting.time = raster * (std::floor(s.sighting.time / raster) + 0.5);
    }
    const Eigen::MatrixXd ours =
        posteriorOf(hypotheses, sightings, options.leds.size(), options.start);
    const Eigen::MatrixXd theirs = exhaustive.posterior(sightings, options.leds.size());
    EXPECT_NEAR(1.0, ours.col(0).sum(), 1e-6);
    error = std::max(error, (ours - theirs).cwiseAbs().maxCoeff());
  }
  return error;
}

TEST(LabelPosterior, AsynchronousMatchesTheExhaustiveComputation) {
  BlinkingOptions options;
  options.codes = fourWords();
  options.period = 0.184;
  options.leds = {2, 3, 9};  // the last does not blink
  options.cameras = 2;
  options.start = 0.0;
  options.exposure = options.period / 32.0;
  options.drop = 0.05;
  options.flip = 0.03;
  // Phases are rounded to a quarter of the grid's step, 32 of them here, and exposures to a 32nd of
  // the period. These need no rounding.
  const double raster = options.period / (4 * 32);
  ASSERT_EQ(32u, Hypotheses(options.codes).phases());
  double error = 0.0;
  for (const double duration : {0.06, 0.12, 0.2}) {
    options.duration = duration;
    error = std::max(error, errorAgainstExhaustive(options, 10, raster));
  }
  EXPECT_LT(error, 1e-3);
}

TEST(LabelPosterior, SynchronousMatchesTheExhaustiveComputation) {
  BlinkingOptions options;
  options.codes = paperCodes(0.125, 0.137);
  options.period = 0.131;
  options.leds = {0, 1, 2, 3};
  options.start = 0.0;
  options.drop = 0.05;
  options.flip = 0.03;
  options.duration = 0.15;
  const double four = errorAgainstExhaustive(options, 3, 0.0);
  options.leds = {2, 0, 7};
  options.cameras = 2;
  const double some = errorAgainstExhaustive(options, 3, 0.0);
  options.leds = {1};
  const double one = errorAgainstExhaustive(options, 3, 0.0);
  // With many periods phases must be rounded.
  EXPECT_LT(four, 0.1);
  EXPECT_LT(some, 0.1);
  EXPECT_LT(one, 0.1);
}

TEST(LabelPosterior, IsThePriorWhereTwoLedsHaveShownOneCodeForLong) {
  BlinkingOptions options;
  options.codes = paperCodes(0.1, 0.1);
  options.leds = {0, 0};
  options.cameras = 8;
  options.start = 0.0;
  options.duration = 20.0;
  const Hypotheses hypotheses(options.codes, 60.0);
  Random random(1);
  const Eigen::MatrixXd posterior =
      posteriorOf(hypotheses, test::simulateBlinking(options, &random), 2, options.start);
  for (Eigen::Index led = 0; led < 2; ++led) {
    for (Eigen::Index label = 0; label < 4; ++label)
      EXPECT_NEAR(0.99 / 4.0, posterior(label, led), 1e-9);
    EXPECT_NEAR(0.01, posterior(4, led), 1e-9);
  }
}

/// Number of runs with a wrong likeliest label.
int wrongRuns(const BlinkingOptions& options, const Hypotheses& hypotheses, int runs) {
  int wrong_runs = 0;
  for (int run = 0; run < runs; ++run) {
    Random random(static_cast<unsigned>(run));
    const Eigen::MatrixXd posterior = posteriorOf(
        hypotheses, test::simulateBlinking(options, &random), options.leds.size(), options.start);
    bool wrong = false;
    for (std::size_t led = 0; led < options.leds.size(); ++led) {
      Eigen::Index label = 0;
      posterior.col(static_cast<Eigen::Index>(led)).maxCoeff(&label);
      wrong |= static_cast<std::size_t>(label) != options.leds[led];
    }
    wrong_runs += wrong;
  }
  return wrong_runs;
}

/// Number of errors that one test of a thousand exceeds by chance, when `expected` is the mean.
int poissonBound(double expected) {
  double term = std::exp(-expected);
  double sum = term;
  int count = 0;
  while (sum < 0.999) {
    term *= expected / ++count;
    sum += term;
  }
  return count;
}

TEST(LabelPosterior, ThePapersSchemeIsReadWithinTwoPeriods) {
  BlinkingOptions options;
  options.codes = paperCodes(0.11, 0.25);
  options.leds = {0, 1, 2, 3};
  options.drop = 0.05;
  options.flip = 0.01;
  const Hypotheses hypotheses(options.codes);
  constexpr int kRuns = 40;
  int wrong = 0, runs = 0;
  for (const std::size_t cameras : {1, 3}) {
    for (const double period : {0.11, 0.12, 0.137, 0.2}) {
      options.cameras = cameras;
      options.period = period;
      options.duration = 2.0 * period;
      wrong += wrongRuns(options, hypotheses, kRuns);
      runs += kRuns;
    }
  }
  EXPECT_LE(wrong, poissonBound(0.001 * runs));
}

TEST(LabelPosterior, CyclicCodesAreReadIn200And400Milliseconds) {
  BlinkingOptions options;
  options.codes = fourWords();
  options.period = 0.184;
  options.flip = 0.01;
  const Hypotheses hypotheses(options.codes);
  constexpr int kRuns = 500;
  int wrong_200 = 0, wrong_400 = 0;
  for (std::size_t led = 0; led < 4; ++led) {
    options.leds = {led};
    options.duration = 0.2;
    wrong_200 += wrongRuns(options, hypotheses, kRuns);
    options.duration = 0.4;
    wrong_400 += wrongRuns(options, hypotheses, kRuns);
  }
  EXPECT_LE(wrong_200, poissonBound(0.003 * 4 * kRuns));
  EXPECT_LE(wrong_400, poissonBound(0.0003 * 4 * kRuns));
}

BlinkCodes oneWord() {
  return cyclicCodes({{"led", "0011"}}, 0.025, 0.0);
}

TEST(Hypotheses, RememberThreePeriodsAtLeast) {
  EXPECT_DOUBLE_EQ(Hypotheses(oneWord(), 0.15).memory(), 0.3);
  EXPECT_DOUBLE_EQ(Hypotheses(oneWord()).memory(), 1.0);
}

TEST(Evidence, DarknessIsNeverLessLikelyThanOcclusion) {
  const Hypotheses hypotheses(oneWord());
  Evidence evidence(hypotheses);
  evidence.reset(0.0);
  LogLikelihoods now;
  // Darkness counts from its beginning and fades with the memory; 2000 images exceed the range in
  // which numbers keep one scale.
  for (int i = 0; i < 2000; ++i) {
    const double time = 0.01 * i;
    evidence.add({0, time, 0.001, false});
    evidence.read(&now);
    const double least = 1.001 * std::log(kOccluded) * std::exp(-time);
    ASSERT_GE(now.cells.minCoeff(), least) << time;
    ASSERT_GE(now.steady, least) << time;
  }
  // Seen again: the faded darkness, and the light.
  evidence.add({0, 20.0, 0.001, true});
  evidence.read(&now);
  EXPECT_NEAR(now.steady, std::log(kSeenWhenOn), 1e-6);
}

}  // namespace
}  // namespace wiimote_tracker::identity
