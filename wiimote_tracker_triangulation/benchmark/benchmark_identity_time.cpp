// Processing time of the identification.
#include "benchmark_sections.h"
#include "identity/blinking.h"
#include "wiimote_tracker_triangulation/identity/identifier.h"
#include "wiimote_tracker_triangulation/identity/schemes.h"

#include <algorithm>
#include <string>

namespace wiimote_tracker {
namespace {

using namespace identity;
using geometry::test::Random;
using namespace identity::test;

BenchmarkRow measure(const std::string& name,
                     const BlinkCodes& codes,
                     double period,
                     const BenchmarkSettings& settings) {
  BlinkingOptions options;
  options.codes = codes;
  options.period = period;
  options.leds = {0, 1, 2, 3};
  options.cameras = 4;
  options.duration = 2.0;
  options.drop = 0.05;
  options.flip = 0.01;
  Random random(settings.seed);
  const std::vector<LedSighting> sightings = simulateBlinking(options, &random);
  IdentifierOptions rarely;
  rarely.interval = 1.0;
  double best_add = 1e9, best_decide = 1e9;
  std::size_t cells = 0;
  for (int run = 0; run < std::max(3, settings.runs / 4); ++run) {
    Identifier identifier(codes, rarely);
    const double start = processorTime();
    for (const LedSighting& s : sightings)
      identifier.add(static_cast<std::uint32_t>(s.led), s.sighting);
    const double added = processorTime();
    constexpr int kDecisions = 50;
    for (int i = 0; i < kDecisions; ++i)
      identifier.decide(sightings.back().sighting.time + 2.0 * i);
    const double decided = processorTime();
    best_add = std::min(best_add, (added - start) / static_cast<double>(sightings.size()));
    best_decide = std::min(best_decide, (decided - added) / kDecisions);
    cells = Hypotheses(codes, {}, 1.0).cells();
  }
  return {name,
          {{"cells", cells},
           {"sighting us", 1e6 * best_add},
           {"decision us", 1e6 * best_decide},
           // Four cameras with 100 images per second see four LEDs; default interval of decisions.
           {"core %", 100.0 * (1600.0 * best_add + best_decide / IdentifierOptions().interval)}}};
}

void runTime(const BenchmarkSettings& settings, const RowCallback& row) {
  row(measure("cyclic, 4 words, clocks within 0.1 %", fourWords(0.001), 0.184, settings));
  row(measure("cyclic, 4 words, clocks within 1 %", fourWords(0.01), 0.184, settings));
  row(measure("paper, period known", paperCodes(0.15, 0.15), 0.15, settings));
  row(measure("paper, period 110 to 250 ms", paperCodes(0.11, 0.25), 0.15, settings));
  row(measure("paper, period 110 to 500 ms", paperCodes(0.11, 0.5), 0.15, settings));
  row(measure("paper, period 40 to 250 ms", paperCodes(0.04, 0.25), 0.15, settings));
}

}  // namespace

BenchmarkSection timeSection() {
  return {"time",
          "Four LEDs before four cameras: the least time of some rounds for a sighting and for a "
          "decision about all LEDs, on one core, and what share of it that is at 100 images per "
          "second and camera and 50 decisions per second.",
          runTime};
}

}  // namespace wiimote_tracker
