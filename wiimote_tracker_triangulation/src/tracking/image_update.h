#pragma once

#include "association/assign_spots.h"
#include "group_state.h"

namespace wiimote_tracker::tracking {

/// Updates the tracks with one image: assigns its spots to the tracks and updates each track with
/// its spot. Where two LEDs may have merged into one spot, follows both hypotheses (MergedPair).
///
/// If the image does not fit, all its spots are false detections; but those of one of only two
/// cameras are used, or it would never be known to fit again.
/// @returns tracks as their indices in GroupState::tracks.
association::TrackOfSpot updateTracks(const GroupSetup& setup,
                                      const StoredImage& image,
                                      GroupState* state);

}  // namespace wiimote_tracker::tracking
