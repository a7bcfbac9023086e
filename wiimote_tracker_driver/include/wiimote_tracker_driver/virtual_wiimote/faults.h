#pragma once

#include <cstdint>
#include <string>

namespace wiimote_tracker::virtual_wiimote {

/// Faults of the link between a remote and its host; none by default. Time is in samples of 10 ms.
/// Answers are the reports 0x20..0x22. The same seed and calls give the same faults.
struct Faults {
  std::uint32_t seed = 1;

  double lost_answers = 0.0;  ///< Probability of each answer [0..1].
  double lost_data = 0.0;     ///< Probability of each data report [0..1].
  double late_answers = 0.0;  ///< Probability of each answer [0..1]; later reports overtake it.
  int late_by = 60;           ///< Greatest delay of late answers [samples, >= 1].
  double duplicated = 0.0;    ///< Probability of each report [0..1].
  double truncated = 0.0;     ///< Probability of each report [0..1]; at least its id is left.
  double garbage = 0.0;       ///< Probability per sample [0..1] of a report that no remote
                              ///< sends: an unknown id, or an answer of random bytes.

  double stalls = 0.0;    ///< Probability per sample [0..1] of a stall: reports are delayed, and
                          ///< then come together, in order.
  int stall_length = 16;  ///< [samples, >= 1]

  int unplug_every = 0;  ///< Time until the remote disappears [samples, >= 0]; 0: never.
  int unplug_for = 100;  ///< Time until it is back, power-cycled [samples, >= 1].

  /// Another program uses the remote as Linux's driver hid-wiimote does: it initialises the remote,
  /// sets its own mode after each status report, asks for the battery, looks for a MotionPlus every
  /// 400 samples, sets the LEDs, and programs the camera when its input device is opened.
  bool second_master = false;
};

/// Sets a member by name: "lost_answers=0.1", "second_master=1".
/// @throws std::invalid_argument with a sentence if the name is unknown or the value out of range.
void setFault(Faults& faults, const std::string& text);

}  // namespace wiimote_tracker::virtual_wiimote
