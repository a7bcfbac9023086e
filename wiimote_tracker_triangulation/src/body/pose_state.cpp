#include "wiimote_tracker_triangulation/body/pose_state.h"

#include "pixel_update.h"
#include "wiimote_tracker_triangulation/geometry/so3.h"

namespace wiimote_tracker::body {
namespace {

namespace so3 = geometry::so3;

/// Adds white acceleration over a duration to the covariance of three values and their rates.
void addWhiteAcceleration(double density,
                          double duration,
                          int first,
                          MotionCovariance* covariance) {
  const double rate = density * density * duration;
  const double both = rate * duration / 2.0;
  covariance->block<3, 3>(first, first).diagonal().array() += rate * duration * duration / 3.0;
  covariance->block<3, 3>(first, first + 6).diagonal().array() += both;
  covariance->block<3, 3>(first + 6, first).diagonal().array() += both;
  covariance->block<3, 3>(first + 6, first + 6).diagonal().array() += rate;
}

}  // namespace

void PoseState::move(const MotionVector& step) {
  position += step.head<3>();
  rotation = (so3::exp(step.segment<3>(3)) * rotation).normalized();
  velocity += step.segment<3>(6);
  angular_velocity += step.tail<3>();
}

MotionVector PoseState::minus(const PoseState& other) const {
  MotionVector step;
  step << position - other.position,
      so3::log((rotation * other.rotation.conjugate()).toRotationMatrix()),
      velocity - other.velocity, angular_velocity - other.angular_velocity;
  return step;
}

void PoseState::predict(double acceleration_density,
                        double angular_acceleration_density,
                        double duration) {
  position += duration * velocity;
  const Eigen::Quaterniond turned(so3::exp(duration * angular_velocity));
  rotation = (turned * rotation).normalized();

  // F = [1 0 dt 0; 0 T 0 dt J; 0 0 1 0; 0 0 0 1] by blocks, and P <- F P F'. T is the turn; J, the
  // left Jacobian of SO(3), is to second order the turn by half of T's angle.
  const Eigen::Matrix3d turn = turned.toRotationMatrix();
  const Eigen::Matrix3d by_turning =
      duration * so3::exp(0.5 * duration * angular_velocity).toRotationMatrix();
  covariance.topRows<3>() += duration * covariance.middleRows<3>(6);
  const Eigen::Matrix<double, 3, 12> rows =
      turn * covariance.middleRows<3>(3) + by_turning * covariance.bottomRows<3>();
  covariance.middleRows<3>(3) = rows;
  covariance.leftCols<3>() += duration * covariance.middleCols<3>(6);
  const Eigen::Matrix<double, 12, 3> columns = covariance.middleCols<3>(3) * turn.transpose() +
                                               covariance.rightCols<3>() * by_turning.transpose();
  covariance.middleCols<3>(3) = columns;
  addWhiteAcceleration(acceleration_density, duration, 0, &covariance);
  addWhiteAcceleration(angular_acceleration_density, duration, 3, &covariance);
}

Eigen::Isometry3d PoseState::worldFromBody() const {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = rotation.toRotationMatrix();
  pose.translation() = position;
  return pose;
}

std::optional<LedPrediction> predictLed(const PoseState& state,
                                        const geometry::Camera& camera,
                                        const Eigen::Vector3d& led,
                                        const geometry::PixelNoise& noise) {
  const Eigen::Vector3d arm = state.rotation * led;
  const Eigen::Vector3d point = state.position + arm;
  LedPrediction prediction;
  Eigen::Matrix<double, 2, 3> by_point;
  const std::optional<Eigen::Vector2d> pixel = camera.project(point, &by_point);
  if (!pixel)
    return std::nullopt;
  prediction.pixel = *pixel;
  prediction.jacobian = by_point * pointByPose(arm);
  Eigen::Matrix<double, 6, 1> rates;
  rates << state.velocity, state.angular_velocity;
  const PoseCovariance squared_rates =
      rates * rates.transpose() + state.covariance.bottomRightCorner<6, 6>();
  prediction.noise = noise.stamp_stddev * noise.stamp_stddev * prediction.jacobian * squared_rates *
                     prediction.jacobian.transpose();
  prediction.noise.diagonal().array() += noise.pixel_stddev * noise.pixel_stddev;
  prediction.covariance = prediction.noise + prediction.jacobian * state.poseCovariance() *
                                                 prediction.jacobian.transpose();
  prediction.depth = camera.world_from_camera.linear().col(2).dot(point - camera.center());
  return prediction;
}

}  // namespace wiimote_tracker::body
