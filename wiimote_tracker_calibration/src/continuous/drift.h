#ifndef WIIMOTE_TRACKER_CALIBRATION_CONTINUOUS_DRIFT_H
#define WIIMOTE_TRACKER_CALIBRATION_CONTINUOUS_DRIFT_H

#include <wiimote_tracker_triangulation/geometry/rig.h>

namespace wiimote_tracker::continuous {

/// How far cameras turn by drift from solved_at to a time [s], standard deviation per axis [rad].
double driftUntil(double time, const geometry::Rig& rig);

/// The rig with its covariance widened by what cameras may have done from solved_at to a time [s].
geometry::Rig withDrift(geometry::Rig rig, double time);

/// Whether the cameras' poses differ by no more than the rig's covariance and the most that cameras
/// drift explain: chi-squared of all poses together, 99.9 %.
bool isWithinDrift(const geometry::Rig& rig, const geometry::Rig& adjusted);

}  // namespace wiimote_tracker::continuous

#endif  // WIIMOTE_TRACKER_CALIBRATION_CONTINUOUS_DRIFT_H
