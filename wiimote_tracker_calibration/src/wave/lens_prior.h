#ifndef WIIMOTE_TRACKER_CALIBRATION_SRC_WAVE_LENS_PRIOR_H
#define WIIMOTE_TRACKER_CALIBRATION_SRC_WAVE_LENS_PRIOR_H

#include "wiimote_tracker_calibration/square/rig_model.h"

#include <wiimote_tracker_triangulation/geometry/camera.h>

#include <Eigen/Core>

#include <cmath>

namespace wiimote_tracker::wave {

/// What is known of a lens beforehand, whitened: as square::Uncertainty has it.
inline Eigen::Matrix<double, 5, 1> lensResidual(const geometry::Intrinsics& lens,
                                                const geometry::Intrinsics& start,
                                                const square::Uncertainty& uncertainty) {
  const double log_x = std::log(lens.fx / start.fx);
  const double log_y = std::log(lens.fy / start.fy);
  Eigen::Matrix<double, 5, 1> residual;
  residual << 0.5 * (log_x + log_y) / uncertainty.focal, (log_x - log_y) / uncertainty.aspect,
      (lens.cx - start.cx) / uncertainty.principal_point,
      (lens.cy - start.cy) / uncertainty.principal_point,
      (lens.distortion[0] - start.distortion[0]) / uncertainty.k1;
  return residual;
}

/// Its derivative by fx, fy, cx, cy, k1.
inline Eigen::Matrix<double, 5, 5> lensJacobian(const geometry::Intrinsics& lens,
                                                const square::Uncertainty& uncertainty) {
  Eigen::Matrix<double, 5, 5> jacobian = Eigen::Matrix<double, 5, 5>::Zero();
  jacobian(0, 0) = 0.5 / (uncertainty.focal * lens.fx);
  jacobian(0, 1) = 0.5 / (uncertainty.focal * lens.fy);
  jacobian(1, 0) = 1.0 / (uncertainty.aspect * lens.fx);
  jacobian(1, 1) = -1.0 / (uncertainty.aspect * lens.fy);
  jacobian(2, 2) = 1.0 / uncertainty.principal_point;
  jacobian(3, 3) = 1.0 / uncertainty.principal_point;
  jacobian(4, 4) = 1.0 / uncertainty.k1;
  return jacobian;
}

}  // namespace wiimote_tracker::wave

#endif  // WIIMOTE_TRACKER_CALIBRATION_SRC_WAVE_LENS_PRIOR_H
