#ifndef WIIMOTE_TRACKER_CALIBRATION_SRC_SESSION_PREDICTED_ACCURACY_H
#define WIIMOTE_TRACKER_CALIBRATION_SRC_SESSION_PREDICTED_ACCURACY_H

#include <wiimote_tracker_triangulation/geometry/rig.h>

#include <Eigen/Core>

#include <optional>

namespace wiimote_tracker::session {

/// Derivative of a point, triangulated by maximum likelihood from all cameras that see it, by all
/// parameters of the rig (3 x size of its covariance): true less measured point = derivative *
/// (true less calibrated parameters). Nothing when fewer than two cameras see the point, or all
/// from one place.
std::optional<Eigen::MatrixXd> pointByParameters(const geometry::Rig& rig,
                                                 const Eigen::Vector3d& point);

/// Standard deviation of such a point as far as it comes from the calibration: square root of the
/// trace of D C D^T, with the joint covariance C of the rig [m]. NaN when there is none.
double predictedStddev(const geometry::Rig& rig, const Eigen::Vector3d& point);

}  // namespace wiimote_tracker::session

#endif  // WIIMOTE_TRACKER_CALIBRATION_SRC_SESSION_PREDICTED_ACCURACY_H
