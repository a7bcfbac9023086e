#ifndef WIIMOTE_TRACKER_TRIANGULATION_IDENTITY_BLINK_CODES_H
#define WIIMOTE_TRACKER_TRIANGULATION_IDENTITY_BLINK_CODES_H

#include "wiimote_tracker_triangulation/identity/waveform.h"

#include <string>
#include <vector>

namespace wiimote_tracker::identity {

/// One LED's name and how it blinks.
struct BlinkCode {
  std::string label;  ///< A letter, then letters, digits and _.
  Waveform waveform;
};

/// How the LEDs of a scene blink, so that each can be told from the others.
struct BlinkCodes {
  std::vector<BlinkCode> codes;

  /// The period lies between these [s]; alike when it is known.
  double shortest_period = 0.1;
  double longest_period = 0.1;

  /// All LEDs have one period and begin it together; else each for itself.
  bool synchronous = false;

  /// Most LEDs that can blink together.
  static constexpr std::size_t kMaximumSynchronous = 8;

  /// @throws Error: two that could be confused, one that never blinks or never shines,
  /// labels or periods out of range.
  void check() const;

  /// For how long an LED may be dark [s]: a track must live through that.
  double longestDark() const;
};

}  // namespace wiimote_tracker::identity

#endif  // WIIMOTE_TRACKER_TRIANGULATION_IDENTITY_BLINK_CODES_H
