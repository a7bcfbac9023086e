#pragma once

#include "health/drift_watch.h"

#include <wiimote_tracker_triangulation/geometry/rig.h>

#include <cstddef>
#include <optional>
#include <vector>

namespace wiimote_tracker::health {

/// The median of the residuals of a camera, and its standard deviation from noise and calibration:
/// against the point that the other active cameras see.
/// @param active per camera of the rig. Samples with fewer than two others are left out.
/// @param limit of the median [px]. @returns nothing with fewer than 40 residuals.
std::optional<Drift> driftOf(std::size_t camera,
                             const geometry::Rig& rig,
                             const DriftSamples& samples,
                             const std::vector<bool>& active,
                             double limit);

/// Of two cameras against each other: across the epipolar lines, in x.
std::optional<Drift> driftOfPair(std::size_t a,
                                 std::size_t b,
                                 const geometry::Rig& rig,
                                 const DriftSamples& samples,
                                 double limit);

}  // namespace wiimote_tracker::health
