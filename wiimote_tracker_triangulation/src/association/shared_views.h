#ifndef WIIMOTE_TRACKER_TRIANGULATION_ASSOCIATION_SHARED_VIEWS_H
#define WIIMOTE_TRACKER_TRIANGULATION_ASSOCIATION_SHARED_VIEWS_H

#include "wiimote_tracker_triangulation/geometry/rig.h"

#include <cstddef>
#include <vector>

namespace wiimote_tracker::association {

/// For each camera of the rig, the others (ascending) whose view overlaps with its own within
/// `range` [m] of both, by a grid of points in each view. Mutual. Only these cameras can see one
/// LED together.
std::vector<std::vector<std::size_t>> sharedViews(const geometry::Rig& rig, double range);

}  // namespace wiimote_tracker::association

#endif  // WIIMOTE_TRACKER_TRIANGULATION_ASSOCIATION_SHARED_VIEWS_H
