// Wrong labels from sightings alone, without a tracker.
#include "benchmark_sections.h"
#include "identity/blinking.h"
#include "wiimote_tracker_triangulation/identity/identifier.h"
#include "wiimote_tracker_triangulation/identity/schemes.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace wiimote_tracker {
namespace {

using namespace identity;
using geometry::test::Random;
using namespace identity::test;

constexpr int kRunsPerRun = 50;  // simulated runs for each of --runs

const char* const kColumns =
    " wrong %: runs in which the likeliest label of an LED is wrong; given wrong %: runs in which "
    "a label was given that is wrong; none yet %: runs in which an LED has no label yet.";

/// Counts of runs.
struct Score {
  int runs = 0;
  int wrong = 0;          // some LED's likeliest label is wrong
  int given_wrong = 0;    // some LED was given a wrong label
  int none_yet = 0;       // no wrong label was given, but an LED has none
  int counted_wrong = 0;  // some LED is wrong by isCountedWrong()

  double percent(int count) const { return 100.0 * count / runs; }

  BenchmarkRow row(const std::string& name) const {
    return {name,
            {{"runs", runs},
             {"wrong %", percent(wrong)},
             {"given wrong %", percent(given_wrong)},
             {"none yet %", percent(none_yet)},
             {"counting %", percent(counted_wrong)}}};
  }
};

/// Whether some LED's share of seen images is nearer to another label's duty cycle than to its own:
/// the baseline without a decoder.
bool isCountedWrong(const BlinkingOptions& options, const std::vector<LedSighting>& sightings) {
  for (std::size_t led = 0; led < options.leds.size(); ++led) {
    double seen = 0.0, all = 0.0;
    for (const LedSighting& s : sightings) {
      all += s.led == led;
      seen += s.led == led && s.sighting.seen;
    }
    const auto distance = [&](const BlinkCode& code) {
      return std::abs(seen / all - (1.0 - options.drop) * litShare(code.waveform, 0.0, 1.0));
    };
    const auto& codes = options.codes.codes;
    const auto nearest = std::min_element(
        codes.begin(), codes.end(),
        [&](const BlinkCode& a, const BlinkCode& b) { return distance(a) < distance(b); });
    if (nearest != codes.begin() + static_cast<std::ptrdiff_t>(options.leds[led]))
      return true;
  }
  return false;
}

/// Blinking LEDs, observed for options.duration, and the labels at its end. @param score so far
Score simulate(const BlinkingOptions& options,
               const Hypotheses& hypotheses,
               int runs,
               unsigned seed,
               double steady = IdentifierOptions().steady,
               Score score = {}) {
  const double decide_at = IdentifierOptions().decide_at;
  LabelPosterior posterior(hypotheses, steady);
  std::vector<Evidence> evidence(options.leds.size(), Evidence(hypotheses));
  std::vector<const Evidence*> leds;
  for (const Evidence& led : evidence)
    leds.push_back(&led);
  Random random(seed);
  score.runs += runs;
  for (int run = 0; run < runs; ++run) {
    for (Evidence& led : evidence)
      led.reset(options.start);
    const std::vector<LedSighting> sightings = simulateBlinking(options, &random);
    for (const LedSighting& s : sightings)
      evidence[s.led].add(s.sighting);
    const Eigen::MatrixXd& probabilities = posterior.compute(leds);
    bool wrong = false, given_wrong = false, none_yet = false;
    for (std::size_t led = 0; led < leds.size(); ++led) {
      const auto column = probabilities.col(static_cast<Eigen::Index>(led));
      Eigen::Index label = 0;
      column.head(static_cast<Eigen::Index>(hypotheses.labels())).maxCoeff(&label);
      const bool other = static_cast<std::size_t>(label) != options.leds[led];
      wrong |= other;
      given_wrong |= other && column(label) >= decide_at;
      none_yet |= column(label) < decide_at;
    }
    score.wrong += wrong;
    score.given_wrong += given_wrong;
    score.none_yet += none_yet && !given_wrong;
    score.counted_wrong += isCountedWrong(options, sightings);
  }
  return score;
}

/// Two periods of the paper's scheme.
BlinkingOptions paperOptions(const BlinkCodes& codes, double period, std::size_t cameras) {
  BlinkingOptions options;
  options.codes = codes;
  options.leds = {0, 1, 2, 3};
  options.cameras = cameras;
  options.period = period;
  options.duration = 2.0 * period;
  options.drop = 0.05;
  options.flip = 0.01;
  return options;
}

std::string camerasAndPeriod(std::size_t cameras, double period) {
  return std::to_string(cameras) + (cameras == 1 ? " camera, " : " cameras, ") +
         std::to_string(std::lround(1e3 * period)) + " ms";
}

void runPaper(const BenchmarkSettings& settings, const RowCallback& row) {
  const BlinkCodes codes = paperCodes(0.11, 0.5);
  const Hypotheses hypotheses(codes);
  for (const std::size_t cameras : {1, 4}) {
    for (const double period : {0.11, 0.15, 0.2, 0.3, 0.5}) {
      const BlinkingOptions options = paperOptions(codes, period, cameras);
      const int runs = kRunsPerRun * settings.runs;
      BenchmarkRow result =
          simulate(options, hypotheses, runs, settings.seed).row(camerasAndPeriod(cameras, period));
      const Hypotheses known(paperCodes(period, period));
      const Score known_period = simulate(options, known, runs, settings.seed);
      result.figures.push_back(
          {"period known: none yet %", known_period.percent(known_period.none_yet)});
      constexpr double kNoOtherLights = 1e-9;
      const Score all_blink = simulate(options, known, runs, settings.seed, kNoOtherLights);
      result.figures.push_back(
          {"and all blink: none yet %", all_blink.percent(all_blink.none_yet)});
      row(result);
    }
  }
}

void runPeriods(const BenchmarkSettings& settings, const RowCallback& row) {
  const BlinkCodes codes = paperCodes(0.04, 0.25);
  const Hypotheses hypotheses(codes);
  for (const std::size_t cameras : {1, 4}) {
    for (int ms = 40; ms <= 200; ms += ms < 120 ? 5 : 20) {
      const Score score = simulate(paperOptions(codes, 1e-3 * ms, cameras), hypotheses,
                                   kRunsPerRun * settings.runs, settings.seed);
      row(score.row(camerasAndPeriod(cameras, 1e-3 * ms)));
    }
  }
}

/// One LED of each word, at several times after the first image.
BenchmarkRow cyclicRow(const std::string& name,
                       BlinkingOptions options,
                       const Hypotheses& hypotheses,
                       const BenchmarkSettings& settings) {
  BenchmarkRow row{name, {}};
  const auto words = static_cast<int>(options.codes.codes.size());
  for (const int ms : {200, 300, 400, 600}) {
    options.duration = 1e-3 * ms;
    Score score;
    for (int led = 0; led < words; ++led) {
      options.leds = {static_cast<std::size_t>(led)};
      // A run of a single LED is short, so there are many.
      score =
          simulate(options, hypotheses, 20 * kRunsPerRun * settings.runs / words,
                   settings.seed + static_cast<unsigned>(led), IdentifierOptions().steady, score);
    }
    row.figures.emplace_back(format("wrong %% %d ms", ms), score.percent(score.wrong));
    row.figures.emplace_back(format("given wrong %% %d ms", ms), score.percent(score.given_wrong));
    row.figures.emplace_back(format("none yet %% %d ms", ms), score.percent(score.none_yet));
  }
  return row;
}

void runWords(const std::vector<std::string>& words,
              const std::string& rest,
              const BenchmarkSettings& settings,
              const RowCallback& row) {
  BlinkingOptions options;
  options.codes = wordCodes(words, 0.001);
  options.period = 0.023 * static_cast<double>(words[0].size());
  options.flip = 0.01;
  const Hypotheses hypotheses(options.codes);
  for (const std::size_t cameras : {1, 4}) {
    options.cameras = cameras;
    row(cyclicRow(format("%zu words of %zu%s, cameras: %zu", words.size(), words[0].size(),
                         rest.c_str(), cameras),
                  options, hypotheses, settings));
  }
}

void runCyclic(const BenchmarkSettings& settings, const RowCallback& row) {
  WordRules shorter;
  shorter.longest_dark = 2;
  shorter.distance = 1;
  for (const std::size_t count : {4, 8, 16}) {
    runWords(chooseWords(count), "", settings, row);
    runWords(chooseWords(count, shorter), ", 1 apart", settings, row);
  }
}

}  // namespace

BenchmarkSection paperSection() {
  return {
      "paper",
      std::string("Four LEDs, lit for 90, 60, 40, 20 % of a period, two periods after the first "
                  "image; the period is searched within 110 and 500 ms. 5 % missed detections, 1 % "
                  "of sightings flipped, cameras not synchronised. 50 runs per --runs.") +
          kColumns +
          " counting %: wrong by the share of images that show an LED. period known, all blink: "
          "none yet % when these are told beforehand.",
      runPaper};
}

BenchmarkSection periodsSection() {
  return {
      "periods",
      std::string("The same over the period, which is searched within 40 and 250 ms.") + kColumns,
      runPeriods};
}

BenchmarkSection cyclicSection() {
  return {
      "cyclic",
      std::string(
          "One LED with a cyclic code, chips of 23 ms, this long after the first image; 1 apart: "
          "words may differ in one chip; 1 % of sightings flipped. 1000 runs per --runs.") +
          kColumns,
      runCyclic};
}

}  // namespace wiimote_tracker
