#pragma once

#include "group_state.h"
#include "wiimote_tracker_triangulation/tracking/tracker_options.h"

namespace wiimote_tracker::tracking {

/// Whose LED a new track has reacquired: the confirmed track of which this is most likely. Null: it
/// is a new LED.
Track* reacquiredBy(const Track& track, const TrackerOptions& options, GroupState* state);

}  // namespace wiimote_tracker::tracking
