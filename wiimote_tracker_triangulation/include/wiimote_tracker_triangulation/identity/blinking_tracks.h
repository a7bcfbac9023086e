#ifndef WIIMOTE_TRACKER_TRIANGULATION_IDENTITY_BLINKING_TRACKS_H
#define WIIMOTE_TRACKER_TRIANGULATION_IDENTITY_BLINKING_TRACKS_H

#include "wiimote_tracker_triangulation/identity/blink_codes.h"
#include "wiimote_tracker_triangulation/tracking/tracker_options.h"

namespace wiimote_tracker::identity {

/// Adapts a tracker's options to blinking LEDs: tracks survive the dark chips, and the detection
/// probability is multiplied by the share of the time that the LEDs are on.
tracking::TrackerOptions forBlinking(const BlinkCodes& codes, tracking::TrackerOptions options);

}  // namespace wiimote_tracker::identity

#endif  // WIIMOTE_TRACKER_TRIANGULATION_IDENTITY_BLINKING_TRACKS_H
