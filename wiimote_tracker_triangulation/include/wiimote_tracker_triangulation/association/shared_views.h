#ifndef WIIMOTE_TRACKER_TRIANGULATION_ASSOCIATION_SHARED_VIEWS_H
#define WIIMOTE_TRACKER_TRIANGULATION_ASSOCIATION_SHARED_VIEWS_H

#include "wiimote_tracker_triangulation/geometry/rig.h"

#include <cstddef>
#include <vector>

namespace wiimote_tracker::association {

/// For each camera of the rig, the others (ascending) that see some of what it sees within `range`
/// [m] of both. Found on a grid of points in each view, and mutual. Only these cameras can ever see
/// one LED together.
std::vector<std::vector<std::size_t>> sharedViews(const geometry::Rig& rig, double range);

}  // namespace wiimote_tracker::association

#endif  // WIIMOTE_TRACKER_TRIANGULATION_ASSOCIATION_SHARED_VIEWS_H
