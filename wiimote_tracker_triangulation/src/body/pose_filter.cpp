#include "wiimote_tracker_triangulation/body/pose_filter.h"

#include "pixel_update.h"

#include <cmath>

namespace wiimote_tracker::body {

PoseFilter::PoseFilter(const PoseFilterOptions& options,
                       double time,
                       const Eigen::Isometry3d& world_from_body,
                       const PoseCovariance& covariance)
    : options_(&options), time_(time), probabilities_(Weights::Constant(1.0 / kPoseModes)) {
  mean_.position = world_from_body.translation();
  mean_.rotation = world_from_body.linear();
  mean_.covariance.topLeftCorner<6, 6>() = covariance;
  mean_.covariance.diagonal().segment<3>(6).setConstant(std::pow(options.initial_speed, 2));
  mean_.covariance.diagonal().tail<3>().setConstant(std::pow(options.initial_angular_speed, 2));
  states_.fill(mean_);
}

PoseFilter::PoseFilter(const PoseFilterOptions& options, double time, const PoseState& start)
    : options_(&options),
      time_(time),
      probabilities_(Weights::Constant(1.0 / kPoseModes)),
      mean_(start) {
  states_.fill(mean_);
}

void PoseFilter::predict(double time) {
  const double duration = time - time_;
  if (!(duration > 0.0))
    return;
  time_ = time;
  for (int i = 0; i < kPoseModes; ++i) {
    const PoseMode& mode = options_->modes[i];
    states_[i].predict(mode.acceleration_density, mode.angular_acceleration_density, duration);
  }
  // After the prediction, not before as in the textbook: the mode changes at the end.
  mix(duration);
  mean_ = mixture(probabilities_);
}

/// The interaction step: each mode's state becomes the mixture of all, weighted by the
/// probabilities that the body came from their modes.
void PoseFilter::mix(double duration) {
  Eigen::Matrix<double, kPoseModes, kPoseModes> joint;  // probability of (before, now)
  for (int i = 0; i < kPoseModes; ++i) {
    for (int j = 0; j < kPoseModes; ++j)
      joint(i, j) = i == j ? 1.0 : options_->change_rate * duration;
    joint.row(i) *= probabilities_[i] / joint.row(i).sum();
  }
  std::array<PoseState, kPoseModes> mixed;
  for (int j = 0; j < kPoseModes; ++j) {
    probabilities_[j] = joint.col(j).sum();
    mixed[j] = mixture(joint.col(j) / probabilities_[j]);
  }
  states_ = mixed;
}

/// Mean and covariance of the mixture of all states. The mean is one step from the likeliest state,
/// because rotations cannot be averaged directly. @param weights add up to 1
PoseState PoseFilter::mixture(const Weights& weights) const {
  Eigen::Index likeliest;
  weights.maxCoeff(&likeliest);
  PoseState result = states_[likeliest];
  MotionVector step = MotionVector::Zero();
  for (int i = 0; i < kPoseModes; ++i)
    step += weights[i] * states_[i].minus(result);
  result.move(step);
  result.covariance.setZero();
  for (int i = 0; i < kPoseModes; ++i) {
    const MotionVector d = states_[i].minus(result);
    result.covariance += weights[i] * (states_[i].covariance + d * d.transpose());
  }
  return result;
}

void PoseFilter::update(const LedPrediction& prediction, const Eigen::Vector2d& pixel) {
  Weights costs;  // -2 log likelihood, less what all modes have in common
  for (int i = 0; i < kPoseModes; ++i) {
    // The prediction is that of the mean.
    const Eigen::Matrix<double, 6, 1> offset = states_[i].minus(mean_).head<6>();
    const Eigen::Vector2d innovation = pixel - prediction.pixel - prediction.jacobian * offset;
    MotionVector step;
    costs[i] = updateByPixel(prediction.jacobian, innovation, prediction.noise,
                             &states_[i].covariance, &step);
    states_[i].move(step);
  }
  probabilities_.array() *= (-0.5 * (costs.array() - costs.minCoeff())).exp();
  probabilities_ /= probabilities_.sum();
  mean_ = mixture(probabilities_);
}

}  // namespace wiimote_tracker::body
