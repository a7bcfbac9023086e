#ifndef WIIMOTE_TRACKER_BRINGUP_SIMULATION_BLINK_H
#define WIIMOTE_TRACKER_BRINGUP_SIMULATION_BLINK_H

#include "wiimote_tracker_triangulation/identity/waveform.h"

namespace wiimote_tracker::simulation {

/// How an LED blinks, for ever.
struct Blink {
  identity::Waveform waveform;
  double period = 1.0;  ///< [s, > 0]
  double begin = 0.0;   ///< When one of its periods begins [s].

  /// Share of the exposure about `time` [s] for which it shines [0..1]: so much of its light is in
  /// that image. An exposure lasts 1 ms here; how long a Wii Remote's does, nobody knows.
  double light(double time) const;
};

}  // namespace wiimote_tracker::simulation

#endif  // WIIMOTE_TRACKER_BRINGUP_SIMULATION_BLINK_H
