#ifndef WIIMOTE_TRACKER_TRIANGULATION_IDENTITY_SIGHTING_H
#define WIIMOTE_TRACKER_TRIANGULATION_IDENTITY_SIGHTING_H

#include <cstddef>

namespace wiimote_tracker::identity {

/// What one image says about one LED that ought to be in it: in the camera's view, not beside
/// another spot that may have swallowed it, and not perhaps crowded out by four brighter ones. An
/// image that an LED need not be in says nothing and makes no sighting.
struct Sighting {
  std::size_t camera = 0;
  double time = 0.0;      ///< Middle of the exposure [s].
  double exposure = 0.0;  ///< Its length, and the doubt about when it was [s, at least 0].
  bool seen = false;
};

/// How sure a camera is. All cameras alike.
struct SeeingModel {
  double seen_when_on = 0.94;   ///< Probability that an LED is seen while it is on [0.5..0.999].
  double seen_when_off = 0.01;  ///< That something else is taken for it [0.0001..0.2].

  /// Probability that a darkness is no blinking but something in the way [1e-6..0.1]. One camera's
  /// darkness therefore never speaks more strongly against an LED than this.
  double hidden = 0.002;
};

}  // namespace wiimote_tracker::identity

#endif  // WIIMOTE_TRACKER_TRIANGULATION_IDENTITY_SIGHTING_H
