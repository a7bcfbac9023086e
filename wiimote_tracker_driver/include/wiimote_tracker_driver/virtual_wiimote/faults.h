#ifndef WIIMOTE_TRACKER_DRIVER_VIRTUAL_WIIMOTE_FAULTS_H
#define WIIMOTE_TRACKER_DRIVER_VIRTUAL_WIIMOTE_FAULTS_H

#include <cstdint>
#include <string>

namespace wiimote_tracker::virtual_wiimote {

/// Faults between a remote and its host; by default none. Time is in samples of 10 ms. Answers are
/// the reports 0x20..0x22. The same seed and calls give the same faults.
struct Faults {
  std::uint32_t seed = 1;

  double lost_answers = 0.0;  ///< Probability of each answer [0..1].
  double lost_data = 0.0;     ///< Probability of each data report [0..1].
  double late_answers = 0.0;  ///< Probability of each answer [0..1]; others overtake it.
  int late_by = 60;           ///< Late answers come up to so many samples later [>= 1].
  double duplicated = 0.0;    ///< Probability of each report [0..1].
  double truncated = 0.0;     ///< Probability of each report [0..1]; at least its id is left.
  double garbage = 0.0;       ///< Probability per sample [0..1] of a report that the remote never
                              ///< sent: of an id that does not exist, or an answer of random bytes.

  double stalls = 0.0;    ///< Probability per sample [0..1] that the link stalls: reports are held
                          ///< back, then all come at once, in order.
  int stall_length = 16;  ///< [samples, >= 1]

  int unplug_every = 0;  ///< The remote goes away so long after it came [samples, >= 0]; 0: never.
  int unplug_for = 100;  ///< For so long [samples, >= 1]; it comes back power-cycled.

  /// Another program uses the remote as Linux's driver hid-wiimote does: it sets the remote
  /// up, sets its own mode after each status report, asks for the battery, looks for a MotionPlus
  /// every 400 samples, sets the LEDs, and programs the camera when one opens its input device.
  bool second_master = false;
};

/// Sets the member that `text` names to the value it gives: "lost_answers=0.1", "second_master=1".
/// @throws std::invalid_argument with a sentence when there is no such member or the value is out
/// of its range.
void setFault(Faults& faults, const std::string& text);

}  // namespace wiimote_tracker::virtual_wiimote

#endif  // WIIMOTE_TRACKER_DRIVER_VIRTUAL_WIIMOTE_FAULTS_H
