#include "wiimote_tracker_triangulation/identity/blink_codes.h"

#include "wiimote_tracker_triangulation/geometry/error.h"

#include <wiimote_tracker_msgs/text.h>

#include <algorithm>

namespace wiimote_tracker::identity {
namespace {

// Two LEDs must differ in this share of the period; less is not seen in a few periods at 100 Hz.
constexpr double kLeastDifference = 0.05;

void checkWaveform(const BlinkCode& code) {
  double last = -1.0;
  for (const Lit& lit : code.waveform) {
    // Negated, so that NaN is refused.
    if (!(lit.from >= 0.0 && lit.from > last && lit.from < lit.to && lit.to <= 1.0))
      throw Error("the intervals of light of " + code.label +
                  " are not ascending within one period; correct them");
    last = lit.to;
  }
  if (code.waveform.empty())
    throw Error(code.label + " is never on; add an interval of light");
  if (longestDark(code.waveform) <= 0.0)
    throw Error(code.label + " is always on, like any lamp; add a dark interval");
}

}  // namespace

void BlinkCodes::check() const {
  if (codes.empty())
    throw Error("there are no LEDs; name at least one");
  if (!(shortest_period >= 0.02 && shortest_period <= longest_period && longest_period <= 5.0))
    throw Error(
        "the period must be within 0.02 and 5 s, and the shortest not longer than the longest; "
        "correct it");
  if (longest_period > 10.0 * shortest_period)
    throw Error("the longest period is more than ten times the shortest; narrow the range");
  if (synchronous && codes.size() > kMaximumSynchronous)
    throw Error("at most " + std::to_string(kMaximumSynchronous) +
                " LEDs can blink together; use cyclic codes for more");
  for (std::size_t i = 0; i < codes.size(); ++i) {
    if (!isWord(codes[i].label))
      throw Error("'" + codes[i].label + "' is no label; use a letter, then letters, digits and _");
    checkWaveform(codes[i]);
    for (std::size_t j = 0; j < i; ++j) {
      if (codes[i].label == codes[j].label)
        throw Error(codes[i].label + " is there twice; give every LED its own name");
      const double apart = synchronous
                               ? difference(codes[i].waveform, codes[j].waveform, 0.0)
                               : differenceInAnyRotation(codes[i].waveform, codes[j].waveform);
      if (apart < kLeastDifference - 1e-9)
        throw Error(codes[j].label + " and " + codes[i].label +
                    (synchronous
                         ? " blink alike; give them different shares"
                         : " blink alike up to a rotation; give them words that differ in every "
                           "rotation"));
    }
  }
}

double BlinkCodes::longestDark() const {
  double longest = 0.0;
  for (const BlinkCode& code : codes)
    longest = std::max(longest, identity::longestDark(code.waveform));
  return longest * longest_period;
}

tracking::TrackerOptions forBlinking(const BlinkCodes& codes, tracking::TrackerOptions options) {
  double light = 0.0;
  for (const BlinkCode& code : codes.codes)
    light += litShare(code.waveform, 0.0, 1.0) / codes.codes.size();
  options.dark_time = codes.longestDark();
  options.prediction_time = std::max(options.prediction_time, 2.0 * options.dark_time);
  options.detection_probability *= light;
  return options;
}

}  // namespace wiimote_tracker::identity
