#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_CROWD_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_CROWD_H

#include "group_state.h"
#include "track.h"
#include "tracker_camera.h"
#include "wiimote_tracker_triangulation/tracking/tracker_options.h"

#include <vector>

namespace wiimote_tracker::tracking {

/// Whether there may be a crowd about a track's LED: more lights than the cameras of a group can
/// report. An LED that they do not report has no track, but it may be merged with one that has: the
/// spot is then between both, at most half of merging_distance from either. Residuals do not always
/// show that, nor does a third camera, which may face another one.
///
/// In a crowd a full camera shows an unknown light instead of the track's LED in its view, and
/// another one shows an unknown light or not the LED. What one camera alone shows may be a lamp, or
/// the camera was moved.
bool isInCrowd(const Track& track,
               const CameraStates& states,
               const std::vector<TrackerCamera>& cameras,
               const TrackerOptions& options,
               double time);

}  // namespace wiimote_tracker::tracking

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_CROWD_H
