#ifndef WIIMOTE_TRACKER_TRIANGULATION_BODY_LED_PREDICTION_H
#define WIIMOTE_TRACKER_TRIANGULATION_BODY_LED_PREDICTION_H

#include "wiimote_tracker_triangulation/body/pose_state.h"
#include "wiimote_tracker_triangulation/geometry/camera.h"

#include <Eigen/Core>

#include <optional>

namespace wiimote_tracker::body {

/// Predicted measurement of an LED of a body.
struct LedPrediction {
  Eigen::Vector2d pixel;                 ///< [px]
  Eigen::Matrix2d covariance;            ///< Innovation covariance [px^2].
  Eigen::Matrix<double, 2, 6> jacobian;  ///< d pixel / d (position, rotation) [px/m, px/rad].
  double depth;                          ///< Along the optical axis [m].
};

/// Nothing when the LED is behind the camera. @param led in the body's frame [m]
std::optional<LedPrediction> predictLed(const PoseState& state,
                                        const geometry::Camera& camera,
                                        const Eigen::Vector3d& led,
                                        double pixel_stddev);

}  // namespace wiimote_tracker::body

#endif  // WIIMOTE_TRACKER_TRIANGULATION_BODY_LED_PREDICTION_H
