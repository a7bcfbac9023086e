#pragma once

#include <cstddef>
#include <cstdint>

namespace wiimote_tracker {

/// What one or two cameras see instead of the LED.
enum class Misled {
  kMirror,    ///< The LED in a wall or in the floor.
  kOtherLed,  ///< Another one on its own way.
  kCarried,   ///< Another one carried along, 0.25 to 0.6 m away.
  kLamp,
  kMasked,     ///< Nothing.
  kTwoLights,  ///< Two cameras: each one of the lights above, but not the same.
};

struct MisledTrial {
  int changes = 0;     ///< Of the rig; all that were proposed are applied.
  double worse = 0.0;  ///< RMS error of the volume afterwards less that before [m].
};

/// 45 s of tracking with a well calibrated rig of four cameras, of which one or two are misled all
/// the time or in part of each 10 s. @param leds of as many persons, or on one body; each is seen
/// as another light.
MisledTrial runMisledTrial(Misled by,
                           std::uint64_t seed,
                           std::size_t leds = 1,
                           bool on_body = false);

/// Changes proposed in the first seconds of each of 24 hours, in which one LED rests, or none
/// shines; 5 % of the images have a false detection.
int changesAtRest(bool with_led, int seconds, std::uint64_t seed);

}  // namespace wiimote_tracker
