#include "wiimote_tracker_triangulation/body/led_prediction.h"

#include "wiimote_tracker_triangulation/geometry/so3.h"

namespace wiimote_tracker::body {

std::optional<LedPrediction> predictLed(const PoseState& state,
                                        const geometry::Camera& camera,
                                        const Eigen::Vector3d& led,
                                        double pixel_stddev) {
  const Eigen::Vector3d arm = state.rotation * led;
  const Eigen::Vector3d point = state.position + arm;
  LedPrediction prediction;
  Eigen::Matrix<double, 2, 3> by_point;
  const std::optional<Eigen::Vector2d> pixel = camera.project(point, &by_point);
  if (!pixel)
    return std::nullopt;
  prediction.pixel = *pixel;
  prediction.jacobian.leftCols<3>() = by_point;
  prediction.jacobian.rightCols<3>() = -by_point * geometry::so3::skew(arm);
  prediction.covariance =
      prediction.jacobian * state.poseCovariance() * prediction.jacobian.transpose();
  prediction.covariance.diagonal().array() += pixel_stddev * pixel_stddev;
  prediction.depth = camera.world_from_camera.linear().col(2).dot(point - camera.center());
  return prediction;
}

}  // namespace wiimote_tracker::body
