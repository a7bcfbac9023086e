#pragma once

#include "geometry/random_rigs.h"
#include "wiimote_tracker_triangulation/identity/blink_codes.h"
#include "wiimote_tracker_triangulation/identity/hypotheses.h"
#include "wiimote_tracker_triangulation/identity/schemes.h"

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

namespace wiimote_tracker::identity::test {

/// The paper's four LEDs, on for 90, 60, 40 and 20 % of a common period [s].
inline BlinkCodes paperCodes(double shortest, double longest) {
  return dutyCodes({{"a", 0.9}, {"b", 0.6}, {"c", 0.4}, {"d", 0.2}}, shortest, longest);
}

/// Cyclic codes with chips of 23 ms. @param tolerance of the clocks, relative
inline BlinkCodes wordCodes(const std::vector<std::string>& words, double tolerance) {
  std::vector<CyclicLed> leds;
  for (const std::string& word : words)
    leds.push_back({"led_" + std::to_string(leds.size()), word});
  return cyclicCodes(leds, 0.023, tolerance);
}

inline BlinkCodes fourWords(double tolerance = 0.0) {
  return wordCodes(chooseWords(4), tolerance);
}

/// How LEDs blink and cameras see. LED i has label i.
struct BlinkingOptions {
  BlinkCodes codes;
  double period = 0.1;            ///< [s]
  std::vector<std::size_t> leds;  ///< LEDs present; a number beyond the labels does not blink.
  std::size_t cameras = 1;
  double start = 1000.0;         ///< [s]
  double duration = 1.0;         ///< [s]
  double image_interval = 0.01;  ///< Of each camera, at its own phase [s].
  double exposure = 0.001;       ///< [s]
  double drop = 0.0;             ///< Probability that an LED that is on is not seen.
  double flip = 0.0;             ///< Probability that a sighting is inverted.

  /// Whether an LED is occluded.
  std::function<bool(std::size_t camera, std::size_t led, double time)> hidden;
};

struct LedSighting {
  std::size_t led;  ///< Index in BlinkingOptions::leds.
  Sighting sighting;
};

/// The sightings of blinking LEDs by unsynchronised cameras, in the order of time. Those of an LED
/// begin when it is first seen, as a tracker's do.
inline std::vector<LedSighting> simulateBlinking(const BlinkingOptions& options,
                                                 geometry::test::Random* random) {
  const double common_phase = random->uniform(0.0, 1.0);
  std::vector<double> phases;
  // How much of an exposure must be lit varies with distance and brightness.
  std::vector<double> thresholds;
  for (std::size_t i = 0; i < options.leds.size(); ++i) {
    phases.push_back(options.codes.synchronous ? common_phase : random->uniform(0.0, 1.0));
    for (std::size_t camera = 0; camera < options.cameras; ++camera)
      thresholds.push_back(random->uniform(0.05, 0.95));
  }
  std::vector<LedSighting> sightings;
  for (std::size_t camera = 0; camera < options.cameras; ++camera) {
    const double first = options.start + options.image_interval * random->uniform(0.0, 1.0);
    for (int k = 0; first + k * options.image_interval < options.start + options.duration; ++k) {
      const double time = first + k * options.image_interval;
      for (std::size_t i = 0; i < options.leds.size(); ++i) {
        bool on = true;
        if (options.leds[i] < options.codes.codes.size()) {
          const double begin = (time - options.start - 0.5 * options.exposure) / options.period;
          on = litShare(options.codes.codes[options.leds[i]].waveform, begin + phases[i],
                        options.exposure / options.period) >
               thresholds[i * options.cameras + camera];
        }
        bool seen = on && random->uniform(0.0, 1.0) >= options.drop;
        if (random->uniform(0.0, 1.0) < options.flip)
          seen = !seen;
        if (options.hidden && options.hidden(camera, i, time))
          seen = false;
        sightings.push_back({i, {camera, time, options.exposure, seen}});
      }
    }
  }
  std::stable_sort(
      sightings.begin(), sightings.end(),
      [](const LedSighting& a, const LedSighting& b) { return a.sighting.time < b.sighting.time; });
  std::vector<char> begun(options.leds.size(), 0);
  const auto too_early = [&](const LedSighting& s) {
    begun[s.led] |= static_cast<char>(s.sighting.seen);
    return !begun[s.led];
  };
  // In order: std::remove_if applies its condition to each once, from the first to the last.
  sightings.erase(std::remove_if(sightings.begin(), sightings.end(), std::ref(too_early)),
                  sightings.end());
  return sightings;
}

}  // namespace wiimote_tracker::identity::test
