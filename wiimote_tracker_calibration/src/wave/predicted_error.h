#ifndef WIIMOTE_TRACKER_CALIBRATION_SRC_WAVE_PREDICTED_ERROR_H
#define WIIMOTE_TRACKER_CALIBRATION_SRC_WAVE_PREDICTED_ERROR_H

#include <wiimote_tracker_triangulation/geometry/rig.h>

#include <Eigen/Core>

#include <vector>

namespace wiimote_tracker::wave {

/// RMS errors of triangulated points as far as they come from the calibration [m].
struct PredictedError {
  double absolute = 0.0;  ///< In the world of the calibration.
  double shape = 0.0;     ///< After the best rigid motion: independent of where the world is.
};

/// To first order, for maximum-likelihood points from all cameras that see them. The rig
/// must have a covariance. NaN when fewer than three points are seen by two.
PredictedError predictedError(const geometry::Rig& rig, const std::vector<Eigen::Vector3d>& points);

}  // namespace wiimote_tracker::wave

#endif  // WIIMOTE_TRACKER_CALIBRATION_SRC_WAVE_PREDICTED_ERROR_H
