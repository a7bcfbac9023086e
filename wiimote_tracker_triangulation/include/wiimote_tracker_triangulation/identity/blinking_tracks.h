#ifndef WIIMOTE_TRACKER_TRIANGULATION_IDENTITY_BLINKING_TRACKS_H
#define WIIMOTE_TRACKER_TRIANGULATION_IDENTITY_BLINKING_TRACKS_H

#include "wiimote_tracker_triangulation/identity/blink_codes.h"
#include "wiimote_tracker_triangulation/tracking/tracker_options.h"

namespace wiimote_tracker::identity {

/// A tracker's options for LEDs that blink so, from those for LEDs that are always on: it waits for
/// LEDs that are dark, and expects them in no more images than they shine in.
tracking::TrackerOptions forBlinking(const BlinkCodes& codes, tracking::TrackerOptions options);

}  // namespace wiimote_tracker::identity

#endif  // WIIMOTE_TRACKER_TRIANGULATION_IDENTITY_BLINKING_TRACKS_H
