#pragma once

#include "wiimote_tracker_triangulation/geometry/rig.h"

#include <cstddef>
#include <vector>

namespace wiimote_tracker::geometry {

/// For each camera of the rig, the others (ascending) whose view overlaps with its own within
/// `range` [m] of both, by a grid of points in each view. Mutual. Only these cameras can see one
/// LED together.
std::vector<std::vector<std::size_t>> sharedViews(const Rig& rig, double range);

/// Divides the cameras of a rig into groups that share no view. @param partners see sharedViews().
std::vector<std::vector<std::size_t>> groupsOf(
    const std::vector<std::vector<std::size_t>>& partners);

}  // namespace wiimote_tracker::geometry
