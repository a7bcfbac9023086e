#ifndef WIIMOTE_TRACKER_CALIBRATION_REMAP_CHECKS_H
#define WIIMOTE_TRACKER_CALIBRATION_REMAP_CHECKS_H

#include "wiimote_tracker_calibration/remap/fit.h"

#include <string>
#include <vector>

namespace wiimote_tracker::remap {

/// @throws Error when no model at all can be fitted to the points; see fitRemap().
void checkPoints(const std::vector<KnownPoint>& points);

}  // namespace wiimote_tracker::remap

#endif  // WIIMOTE_TRACKER_CALIBRATION_REMAP_CHECKS_H
