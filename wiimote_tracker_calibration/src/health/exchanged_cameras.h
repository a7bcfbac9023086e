#pragma once

#include "health/drift_watch.h"

#include <wiimote_tracker_triangulation/geometry/rig.h>

#include <cstddef>
#include <optional>
#include <utility>

namespace wiimote_tracker::health {

/// The two cameras that seem to stand in each other's places: with their poses exchanged the
/// residuals of all scatter a quarter as much, and at most half as much as with those of any other
/// two. (A turn moves their median; another place scatters them.)
/// @returns nothing for fewer than three cameras, or where two other ones explain as much, as in a
/// square of cameras whose opposite ones were exchanged.
std::optional<std::pair<std::size_t, std::size_t>> exchangedCameras(const geometry::Rig& rig,
                                                                    const DriftSamples& samples);

}  // namespace wiimote_tracker::health
