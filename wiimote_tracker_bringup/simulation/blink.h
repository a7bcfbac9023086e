#ifndef WIIMOTE_TRACKER_BRINGUP_SIMULATION_BLINK_H
#define WIIMOTE_TRACKER_BRINGUP_SIMULATION_BLINK_H

#include "wiimote_tracker_triangulation/identity/waveform.h"

namespace wiimote_tracker::simulation {

/// Periodic blinking of an LED.
struct Blink {
  identity::Waveform waveform;
  double period = 1.0;  ///< [s, > 0]
  double begin = 0.0;   ///< Start of one of its periods [s].

  /// Share of the exposure around `time` [s] in which the LED is on [0..1], which scales its
  /// brightness. An exposure lasts 1 ms here; that of a Wii Remote is unknown.
  double light(double time) const;
};

}  // namespace wiimote_tracker::simulation

#endif  // WIIMOTE_TRACKER_BRINGUP_SIMULATION_BLINK_H
