// Wrong labels from sightings alone, without a tracker.
#include "benchmark_identity_sections.h"
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
using identity::test::BlinkingOptions;
using identity::test::LedSighting;
using identity::test::simulateBlinking;

constexpr int kRunsPerRun = 50;  // of --runs

const char* const kColumns =
    " wrong %: of the runs, in which the likeliest label of an LED is not its own; given wrong %: "
    "in which a label was given (as probable as a decision needs) that is not its own; none yet %: "
    "in which no wrong label was given, but an LED has none.";

/// Runs with an LED whose ...
struct Score {
  int runs = 0;
  int wrong = 0;          // likeliest label is not its own
  int given_wrong = 0;    // label is given and not its own
  int none_yet = 0;       // label is not given, and none is given wrongly
  int counted_wrong = 0;  // share of images that show it is nearest to that of another label

  void add(const Score& other) {
    runs += other.runs;
    wrong += other.wrong;
    given_wrong += other.given_wrong;
    none_yet += other.none_yet;
    counted_wrong += other.counted_wrong;
  }

  double percent(int count) const { return 100.0 * count / runs; }

  BenchmarkRow row(const std::string& name, bool with_counting) const {
    BenchmarkRow row{name,
                     {{"runs", runs},
                      {"wrong %", percent(wrong)},
                      {"given wrong %", percent(given_wrong)},
                      {"none yet %", percent(none_yet)}}};
    if (with_counting)
      row.figures.push_back({"counting %", percent(counted_wrong)});
    return row;
  }
};

/// Whether some LED's share of sightings is nearer to that of another label than to its own's: what
/// one would do without a decoder.
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

/// LEDs that blink for options.duration, and what is thought of them then.
Score simulate(const BlinkingOptions& options,
               const Hypotheses& hypotheses,
               int runs,
               unsigned seed) {
  const double decide_at = IdentifierOptions().decide_at;
  LabelPosterior posterior(hypotheses, IdentifierOptions().steady);
  std::vector<Evidence> evidence(options.leds.size(), Evidence(hypotheses));
  std::vector<const Evidence*> leds;
  for (const Evidence& led : evidence)
    leds.push_back(&led);
  Random random(seed);
  Score score;
  for (score.runs = 0; score.runs < runs; ++score.runs) {
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

BlinkCodes paperCodes(double shortest, double longest) {
  return dutyCodes({{"led_1", 0.9}, {"led_2", 0.6}, {"led_3", 0.4}, {"led_4", 0.2}}, shortest,
                   longest);
}

BlinkingOptions paperOptions(const BlinkCodes& codes,
                             double period,
                             double periods,
                             std::size_t cameras) {
  BlinkingOptions options;
  options.codes = codes;
  options.leds = {0, 1, 2, 3};
  options.cameras = cameras;
  options.period = period;
  options.duration = periods * period;
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
  const Hypotheses hypotheses(codes, {}, IdentifierOptions().memory);
  for (const std::size_t cameras : {1, 2, 4}) {
    for (const double period : {0.11, 0.12, 0.13, 0.137, 0.15, 0.2, 0.3, 0.5}) {
      const Score score = simulate(paperOptions(codes, period, 2.0, cameras), hypotheses,
                                   kRunsPerRun * settings.runs, settings.seed);
      row(score.row(camerasAndPeriod(cameras, period), true));
    }
  }
}

void runSomeInView(const BenchmarkSettings& settings, const RowCallback& row) {
  const BlinkCodes codes = paperCodes(0.11, 0.5);
  const Hypotheses hypotheses(codes, {}, IdentifierOptions().memory);
  const std::vector<std::vector<std::size_t>> subsets = {{0, 1, 2}, {1, 2, 3}, {0, 3}, {1, 2},
                                                         {0},       {1},       {2},    {3}};
  for (const double periods : {2.0, 4.0}) {
    for (const std::vector<std::size_t>& leds : subsets) {
      BlinkingOptions options = paperOptions(codes, 0.15, periods, 1);
      options.leds = leds;
      std::string name =
          camerasAndPeriod(1, 0.15) + ", " + std::to_string(std::lround(periods)) + " periods, LED";
      for (const std::size_t led : leds)
        name += " " + std::to_string(led + 1);
      row(simulate(options, hypotheses, kRunsPerRun * settings.runs, settings.seed)
              .row(name, true));
    }
  }
}

void runPeriods(const BenchmarkSettings& settings, const RowCallback& row) {
  const BlinkCodes codes = paperCodes(0.04, 0.25);
  const Hypotheses hypotheses(codes, {}, IdentifierOptions().memory);
  for (const std::size_t cameras : {1, 4}) {
    for (int ms = 40; ms <= 200; ms += ms < 120 ? 5 : 20) {
      const Score score = simulate(paperOptions(codes, 1e-3 * ms, 2.0, cameras), hypotheses,
                                   kRunsPerRun * settings.runs, settings.seed);
      row(score.row(camerasAndPeriod(cameras, 1e-3 * ms), true));
    }
  }
}

void runCyclic(const BenchmarkSettings& settings, const RowCallback& row) {
  for (const double chip : {0.023, 0.02}) {
    for (const std::size_t count : {4, 8, 16}) {
      std::vector<CyclicLed> leds;
      for (const std::string& word : chooseWords(count))
        leds.push_back({"led_" + std::to_string(leds.size()), word});
      const BlinkCodes codes = cyclicCodes(leds, chip, 0.001);
      const Hypotheses hypotheses(codes, {}, IdentifierOptions().memory);
      for (const std::size_t cameras : {1, 4}) {
        for (const double duration : {0.1, 0.2, 0.4, 0.6}) {
          BlinkingOptions options;
          options.codes = codes;
          options.cameras = cameras;
          options.period = chip * static_cast<double>(leds[0].word.size());
          options.duration = duration;
          options.flip = 0.01;
          Score score;
          for (std::size_t led = 0; led < count; ++led) {
            options.leds = {led};
            // Short runs of single LEDs: many of them.
            score.add(simulate(options, hypotheses,
                               20 * kRunsPerRun * settings.runs / static_cast<int>(count),
                               settings.seed + static_cast<unsigned>(led)));
          }
          row(score.row(std::to_string(count) + " words of " + std::to_string(leds[0].word.size()) +
                            " x " + std::to_string(std::lround(1e3 * chip)) + " ms, " +
                            camerasAndPeriod(cameras, duration),
                        false));
        }
      }
    }
  }
}

}  // namespace

BenchmarkSection paperSection() {
  return {"paper",
          std::string("Four LEDs, 90/60/40/20 %, two periods after the first image; the period is "
                      "looked for within 110 and 500 ms. 5 % of detections dropped, 1 % of "
                      "sightings flipped, cameras not synchronised. 50 runs per --runs.") +
              kColumns +
              " counting %: wrong by the share of images that show it, nearest to its label's.",
          runPaper};
}

BenchmarkSection someInViewSection() {
  return {"some_in_view", std::string("The same with only some LEDs in view.") + kColumns,
          runSomeInView};
}

BenchmarkSection periodsSection() {
  return {"periods",
          std::string("The same as the first, over the period; it is looked for within 40 and 250 "
                      "ms.") +
              kColumns,
          runPeriods};
}

BenchmarkSection cyclicSection() {
  return {"cyclic",
          std::string("One LED with a cyclic code, so many ms after the first image; 1 % of "
                      "sightings flipped. 1000 runs per --runs.") +
              kColumns,
          runCyclic};
}

}  // namespace wiimote_tracker
