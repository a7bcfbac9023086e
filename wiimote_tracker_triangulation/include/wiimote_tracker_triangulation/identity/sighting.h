#ifndef WIIMOTE_TRACKER_TRIANGULATION_IDENTITY_SIGHTING_H
#define WIIMOTE_TRACKER_TRIANGULATION_IDENTITY_SIGHTING_H

#include <cstddef>

namespace wiimote_tracker::identity {

/// Whether one image shows one LED that it ought to show: inside the camera's view, not near
/// another spot with which it may merge, and not displaced by four brighter ones. Other images make
/// no sighting.
struct Sighting {
  std::size_t camera = 0;
  double time = 0.0;      ///< Middle of the exposure [s].
  double exposure = 0.0;  ///< Its length plus the uncertainty of its time [s, >= 0].
  bool seen = false;
};

/// Detection model of all cameras.
struct SeeingModel {
  double seen_when_on = 0.94;   ///< Detection probability of an LED that is on [0.5..0.999].
  double seen_when_off = 0.01;  ///< Probability of a false detection [0.0001..0.2].

  /// Probability that a dark interval is an occlusion [1e-6..0.1]. It limits the evidence of one
  /// camera's dark interval against an LED.
  double hidden = 0.002;
};

}  // namespace wiimote_tracker::identity

#endif  // WIIMOTE_TRACKER_TRIANGULATION_IDENTITY_SIGHTING_H
