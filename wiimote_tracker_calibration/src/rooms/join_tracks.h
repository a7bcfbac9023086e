#ifndef WIIMOTE_TRACKER_CALIBRATION_SRC_ROOMS_JOIN_TRACKS_H
#define WIIMOTE_TRACKER_CALIBRATION_SRC_ROOMS_JOIN_TRACKS_H

#include "rooms/walk.h"

#include <vector>

namespace wiimote_tracker::rooms {

/// Joins the tracks of one room that are of the same LED: one that goes along another one, and one
/// that goes on where another one was lost a moment ago.
/// @param tracks points in the order of time. @returns paths in the order of their beginnings.
std::vector<Path> joinTracks(std::vector<Path> tracks);

}  // namespace wiimote_tracker::rooms

#endif  // WIIMOTE_TRACKER_CALIBRATION_SRC_ROOMS_JOIN_TRACKS_H
