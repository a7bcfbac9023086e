#include "wiimote_tracker_triangulation/body/pose_filter.h"

#include "wiimote_tracker_triangulation/geometry/so3.h"

namespace wiimote_tracker::body {
namespace {

namespace so3 = geometry::so3;

/// Process noise of white acceleration over dt, one axis: variances of value and rate, covariance.
void addWalk(double density, double dt, double* value, double* both, double* rate) {
  const double q = density * density;
  *value = q * dt * dt * dt / 3.0;
  *both = q * dt * dt / 2.0;
  *rate = q * dt;
}

}  // namespace

PoseFilter::PoseFilter(const PoseFilterOptions& options,
                       double time,
                       const Eigen::Isometry3d& world_from_body,
                       const PoseCovariance& covariance)
    : options_(&options),
      time_(time),
      position_(world_from_body.translation()),
      rotation_(world_from_body.linear()) {
  covariance_.setZero();
  covariance_.topLeftCorner<6, 6>() = covariance;
  covariance_.diagonal().segment<3>(6).setConstant(options.initial_speed * options.initial_speed);
  covariance_.diagonal().tail<3>().setConstant(options.initial_angular_speed *
                                               options.initial_angular_speed);
}

void PoseFilter::predict(double time) {
  const double dt = time - time_;
  if (!(dt > 0.0))
    return;
  time_ = time;
  position_ += dt * velocity_;
  const Eigen::Quaterniond turned(so3::exp(dt * turning_));
  rotation_ = (turned * rotation_).normalized();

  // F = [1 0 dt 0; 0 T 0 dt (half the turn); 0 0 1 0; 0 0 0 1] by blocks, and P <- F P F'.
  const Eigen::Matrix3d turn = turned.toRotationMatrix();
  const Eigen::Matrix3d by_turning = dt * so3::exp(0.5 * dt * turning_).toRotationMatrix();
  covariance_.topRows<3>() += dt * covariance_.middleRows<3>(6);
  Eigen::Matrix<double, 3, 12> rows =
      turn * covariance_.middleRows<3>(3) + by_turning * covariance_.bottomRows<3>();
  covariance_.middleRows<3>(3) = rows;
  covariance_.leftCols<3>() += dt * covariance_.middleCols<3>(6);
  Eigen::Matrix<double, 12, 3> columns = covariance_.middleCols<3>(3) * turn.transpose() +
                                         covariance_.rightCols<3>() * by_turning.transpose();
  covariance_.middleCols<3>(3) = columns;

  double value = 0.0;
  double both = 0.0;
  double rate = 0.0;
  addWalk(options_->acceleration_density, dt, &value, &both, &rate);
  for (int i = 0; i < 3; ++i) {
    covariance_(i, i) += value;
    covariance_(i, i + 6) += both;
    covariance_(i + 6, i) += both;
    covariance_(i + 6, i + 6) += rate;
  }
  addWalk(options_->angular_acceleration_density, dt, &value, &both, &rate);
  for (int i = 3; i < 6; ++i) {
    covariance_(i, i) += value;
    covariance_(i, i + 6) += both;
    covariance_(i + 6, i) += both;
    covariance_(i + 6, i + 6) += rate;
  }
}

std::optional<LedPrediction> PoseFilter::predictLed(const geometry::Camera& camera,
                                                    const Eigen::Vector3d& led,
                                                    double pixel_stddev) const {
  const Eigen::Vector3d arm = rotation_ * led;
  const Eigen::Vector3d point = position_ + arm;
  LedPrediction prediction;
  Eigen::Matrix<double, 2, 3> by_point;
  const std::optional<Eigen::Vector2d> pixel = camera.project(point, &by_point);
  if (!pixel)
    return std::nullopt;
  prediction.pixel = *pixel;
  prediction.jacobian.leftCols<3>() = by_point;
  prediction.jacobian.rightCols<3>() = -by_point * so3::skew(arm);
  prediction.covariance =
      prediction.jacobian * covariance_.topLeftCorner<6, 6>() * prediction.jacobian.transpose();
  prediction.covariance.diagonal().array() += pixel_stddev * pixel_stddev;
  prediction.depth = camera.world_from_camera.linear().col(2).dot(point - camera.center());
  return prediction;
}

void PoseFilter::update(const LedPrediction& prediction,
                        const Eigen::Vector2d& pixel,
                        double pixel_stddev) {
  const Eigen::Matrix<double, 12, 2> to_pixel =
      covariance_.leftCols<6>() * prediction.jacobian.transpose();
  const Eigen::Matrix<double, 12, 2> gain = to_pixel * prediction.covariance.inverse();
  const State step = gain * (pixel - prediction.pixel);
  position_ += step.head<3>();
  rotation_ = (so3::exp(step.segment<3>(3)) * rotation_).normalized();
  velocity_ += step.segment<3>(6);
  turning_ += step.tail<3>();

  // Joseph's form keeps the covariance positive definite: (I - K H) P (I - K H)' + K R K'.
  Eigen::Matrix<double, 12, 12> reduced = covariance_;
  reduced.noalias() -= gain * to_pixel.transpose();
  const Eigen::Matrix<double, 12, 2> left = reduced.leftCols<6>() * prediction.jacobian.transpose();
  covariance_ = reduced;
  covariance_.noalias() -= left * gain.transpose();
  covariance_.noalias() += (pixel_stddev * pixel_stddev) * gain * gain.transpose();
  const MotionCovariance symmetric = 0.5 * (covariance_ + covariance_.transpose());
  covariance_ = symmetric;
}

Eigen::Isometry3d PoseFilter::worldFromBody() const {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = rotation_.toRotationMatrix();
  pose.translation() = position_;
  return pose;
}

}  // namespace wiimote_tracker::body
