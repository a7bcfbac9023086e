#pragma once

#include "wiimote_tracker_triangulation/identity/waveform.h"
#include "wiimote_tracker_triangulation/tracking/tracker_options.h"

#include <string>
#include <vector>

namespace wiimote_tracker::identity {

/// One LED's name and how it blinks.
struct BlinkCode {
  std::string label;  ///< A letter, then letters, digits and _.
  Waveform waveform;
};

/// Blink codes of the LEDs of a scene, which identify each of them.
struct BlinkCodes {
  std::vector<BlinkCode> codes;

  /// Bounds of the period [s]; equal when it is known.
  double shortest_period = 0.1;
  double longest_period = 0.1;

  /// All LEDs share one period and start it together; else each has its own phase.
  bool synchronous = false;

  /// Most LEDs with synchronous codes.
  static constexpr std::size_t kMaximumSynchronous = 8;

  /// @throws Error: two codes that could be confused, one that is always or never on, labels or
  /// periods out of range.
  void check() const;

  /// Longest time that an LED is dark [s]; tracks must survive it.
  double longestDark() const;
};

/// Adapts a tracker's options to blinking LEDs: tracks survive the dark chips, and the detection
/// probability is multiplied by the share of the time that the LEDs are on.
tracking::TrackerOptions forBlinking(const BlinkCodes& codes, tracking::TrackerOptions options);

}  // namespace wiimote_tracker::identity
