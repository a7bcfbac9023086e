#ifndef WIIMOTE_TRACKER_TRIANGULATION_GEOMETRY_IMAGE_RULES_H
#define WIIMOTE_TRACKER_TRIANGULATION_GEOMETRY_IMAGE_RULES_H

#include "wiimote_tracker_triangulation/geometry/rig.h"

#include <Eigen/Core>

#include <cstdint>

namespace wiimote_tracker::geometry {

/// What to add to the stamps of a camera's images while its clock is in this epoch [s]; 0 where the
/// rig's offset does not hold.
double timeOffset(const RigCamera& camera, std::uint32_t clock_epoch);

/// False in a clock epoch that the camera's offset was not calibrated for.
bool isTimeOffsetKnown(const RigCamera& camera, std::uint32_t clock_epoch);

/// Whether light at this pixel is to be ignored.
bool isMasked(const RigCamera& camera, const Eigen::Vector2d& pixel);

}  // namespace wiimote_tracker::geometry

#endif  // WIIMOTE_TRACKER_TRIANGULATION_GEOMETRY_IMAGE_RULES_H
