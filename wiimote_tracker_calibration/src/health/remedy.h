#ifndef WIIMOTE_TRACKER_CALIBRATION_HEALTH_REMEDY_H
#define WIIMOTE_TRACKER_CALIBRATION_HEALTH_REMEDY_H

#include <wiimote_tracker_triangulation/geometry/rig.h>

#include <string>

namespace wiimote_tracker::health {

/// How to calibrate a camera again: alone, if two others with clocks that a wave told can hold it,
/// else with all cameras.
std::string calibrateAgain(const geometry::Rig& rig);

/// What to do about cameras that were moved. @param is_known which ones they are.
std::string putBack(const geometry::Rig& rig, bool is_known);

}  // namespace wiimote_tracker::health

#endif  // WIIMOTE_TRACKER_CALIBRATION_HEALTH_REMEDY_H
