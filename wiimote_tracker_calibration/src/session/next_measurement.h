#ifndef WIIMOTE_TRACKER_CALIBRATION_SRC_SESSION_NEXT_MEASUREMENT_H
#define WIIMOTE_TRACKER_CALIBRATION_SRC_SESSION_NEXT_MEASUREMENT_H

#include "session/verdict.h"
#include "wiimote_tracker_calibration/square/square_layout.h"

#include <wiimote_tracker_triangulation/geometry/rig.h>

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace wiimote_tracker::session {

/// What the solver knows of its errors.
struct JointError {
  Eigen::MatrixXd covariance;  ///< Of the rig's parameters, then of the corners' offsets (2 each).
  double pixel = 0.2;          ///< Standard deviation of a still LED, per axis [px].
};

/// The measurement that lowers the expected error of points at some places most: a length between
/// two corners, or the LED on a known place. To first order: the joint covariance is updated by the
/// measurement, nothing is solved. Nothing when none gains 5 %.
std::optional<NextMeasurement> nextMeasurement(const geometry::Rig& rig,
                                               const square::SquareLayout& layout,
                                               bool z_up,
                                               const std::vector<Eigen::Vector3d>& places,
                                               const JointError& joint);

}  // namespace wiimote_tracker::session

#endif  // WIIMOTE_TRACKER_CALIBRATION_SRC_SESSION_NEXT_MEASUREMENT_H
