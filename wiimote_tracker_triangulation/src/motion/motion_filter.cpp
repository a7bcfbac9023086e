#include "wiimote_tracker_triangulation/motion/motion_filter.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace wiimote_tracker::motion {
namespace {

using Vector2 = Eigen::Vector2d;
using Vector3 = Eigen::Vector3d;
using Matrix2 = Eigen::Matrix2d;
using Matrix3 = Eigen::Matrix3d;
using Matrix23 = Eigen::Matrix<double, 2, 3>;
using Matrix32 = Eigen::Matrix<double, 3, 2>;

}  // namespace

MotionFilter::MotionFilter(const MotionOptions& options,
                           double time,
                           const Vector3& position,
                           const Matrix3& covariance)
    : options_(&options), time_(time), still_p_(position), still_pp_(covariance) {
  // As often in each way as in the long run.
  const double still =
      options.stop_rate > 0.0 ? options.stop_rate / (options.stop_rate + options.start_rate) : 0.0;
  weights_ = {still, 0.5 * (1.0 - still), 0.5 * (1.0 - still)};
  for (int i = 0; i < 2; ++i) {
    const double acceleration = i == 0 ? options.gentle_acceleration : options.brisk_acceleration;
    KinematicState& state = moving_[i];
    state.setMeanZero();
    state.setCovarianceZero();
    state.p = position;
    state.pp = covariance;
    state.vv.diagonal().setConstant(options.initial_speed * options.initial_speed);
    state.aa.diagonal().setConstant(acceleration * acceleration);
  }
}

void MotionFilter::predict(double time) {
  const double duration = time - time_;
  if (!(duration > 0.0))
    return;
  change(duration);
  const SingerStep step(duration, options_->acceleration_time);
  moving_[0].predict(step, options_->gentle_acceleration * options_->gentle_acceleration);
  moving_[1].predict(step, options_->brisk_acceleration * options_->brisk_acceleration);
  still_pp_.diagonal().array() += options_->still_drift * options_->still_drift * duration;
  time_ = time;
}

/// The interaction: each way to move starts from the mixture of those that may have led to it.
void MotionFilter::change(double duration) {
  const auto leave = [duration](double rate) { return rate * duration / (1.0 + rate * duration); };
  const double start = leave(options_->start_rate);
  const double end = leave(options_->stop_rate + options_->change_rate);
  const double all = options_->stop_rate + options_->change_rate;
  const double stop = all > 0.0 ? end * options_->stop_rate / all : 0.0;
  const double swap = end - stop;

  // joint[i][j]: now j after i.
  const double still = weights_[kStill];
  const double gentle = weights_[kGentle];
  const double brisk = weights_[kBrisk];
  const double to_still[3] = {still * (1.0 - start), gentle * stop, brisk * stop};
  const double to_gentle[3] = {still * 0.5 * start, gentle * (1.0 - end), brisk * swap};
  const double to_brisk[3] = {still * 0.5 * start, gentle * swap, brisk * (1.0 - end)};
  const double* to[3] = {to_still, to_gentle, to_brisk};

  const auto before = moving_;
  const Vector3 before_p = still_p_;
  const Matrix3 before_pp = still_pp_;
  for (int j = 0; j < kModels; ++j) {
    weights_[j] = to[j][0] + to[j][1] + to[j][2];
    if (!(weights_[j] > 0.0))
      continue;
    const double share[3] = {to[j][0] / weights_[j], to[j][1] / weights_[j],
                             to[j][2] / weights_[j]};
    if (j == kStill) {
      still_p_ = share[0] * before_p + share[1] * before[0].p + share[2] * before[1].p;
      const Vector3 d[3] = {before_p - still_p_, before[0].p - still_p_, before[1].p - still_p_};
      still_pp_ = share[0] * (before_pp + d[0] * d[0].transpose()) +
                  share[1] * (before[0].pp + d[1] * d[1].transpose()) +
                  share[2] * (before[1].pp + d[2] * d[2].transpose());
      continue;
    }
    // An LED that starts does so from rest, with an acceleration of that way to move.
    const double acceleration =
        j == kGentle ? options_->gentle_acceleration : options_->brisk_acceleration;
    KinematicState started;
    started.setMeanZero();
    started.setCovarianceZero();
    started.p = before_p;
    started.pp = before_pp;
    started.aa.diagonal().setConstant(acceleration * acceleration);

    KinematicState& state = moving_[j - 1];
    state.setMeanZero();
    state.setCovarianceZero();
    state.addMean(share[0], started);
    state.addMean(share[1], before[0]);
    state.addMean(share[2], before[1]);
    state.addCovariance(share[0], started);
    state.addCovariance(share[1], before[0]);
    state.addCovariance(share[2], before[1]);
  }
}

std::optional<PixelPrediction> MotionFilter::predictPixel(const geometry::Camera& camera,
                                                          const PixelNoise& noise) const {
  PixelPrediction prediction;
  prediction.smear_ = noise.stamp_stddev * velocity();
  prediction.pixel_variance_ = noise.pixel_stddev * noise.pixel_stddev;
  if (!linearize(camera, position(), &prediction))
    return std::nullopt;
  return prediction;
}

/// The image of positions near `point`, which need not be the mean. False when it has none.
bool MotionFilter::linearize(const geometry::Camera& camera,
                             const Vector3& point,
                             PixelPrediction* prediction) const {
  const Matrix23& H = prediction->jacobian_;
  const std::optional<Vector2> pixel = camera.project(point, &prediction->jacobian_);
  if (!pixel)
    return false;
  const Vector3 mean = position();
  prediction->pixel_ = *pixel + H * (mean - point);
  const Vector2 smear = H * prediction->smear_;
  Matrix2 noise = smear * smear.transpose();
  noise.diagonal().array() += prediction->pixel_variance_;
  for (int i = 0; i < kModels; ++i) {
    PixelPrediction::Component& component = prediction->components_[i];
    component.weight = weights_[i];
    if (!(component.weight > 0.0))
      continue;
    component.offset = H * ((i == kStill ? still_p_ : moving_[i - 1].p) - mean);
    component.whiten = whitening(H, i == kStill ? still_pp_ : moving_[i - 1].pp, noise);
  }
  return true;
}

/// Whether the image of where the LED may be is flat to a small part of the pixel noise: a
/// displacement d changes the derivatives by d / depth.
bool MotionFilter::isLinear(const geometry::Camera& camera,
                            const PixelPrediction& prediction,
                            const Vector2& pixel) const {
  constexpr double kNegligible = 0.05;  // of the noise's standard deviation
  const Vector3 axis = camera.world_from_camera.linear().col(2);
  const double depth = axis.dot(moving_[0].p - camera.center());
  const double variance =
      std::max({still_pp_.trace(), moving_[0].pp.trace(), moving_[1].pp.trace()});
  const double limit = kNegligible * depth;
  return variance * (pixel - prediction.pixel_).squaredNorm() <
         limit * limit * prediction.pixel_variance_;
}

bool MotionFilter::update(const geometry::Camera& camera,
                          const PixelPrediction& prediction,
                          const Vector2& pixel) {
  constexpr int kIterations = 3;
  if (!pixel.allFinite())
    return false;
  if (isLinear(camera, prediction, pixel)) {
    apply(prediction, pixel);
    return true;
  }
  // Iterated: linearised anew where the spot itself says that the LED is.
  const MotionFilter before = *this;
  apply(prediction, pixel);
  PixelPrediction closer = prediction;
  for (int i = 0; i < kIterations; ++i) {
    if (!before.linearize(camera, position(), &closer))
      break;
    *this = before;
    apply(closer, pixel);
  }
  return true;
}

void MotionFilter::apply(const PixelPrediction& prediction, const Vector2& pixel) {
  double log_likelihoods[kModels];
  double best = -std::numeric_limits<double>::infinity();
  for (int i = 0; i < kModels; ++i) {
    const PixelPrediction::Component& component = prediction.components_[i];
    if (!(component.weight > 0.0))
      continue;
    Innovation innovation;
    innovation.jacobian = prediction.jacobian_;
    innovation.whiten = component.whiten;
    innovation.whitened = component.whiten * (pixel - prediction.pixel_ - component.offset);
    if (i == kStill) {
      const Matrix32 w =
          still_pp_ * innovation.jacobian.transpose() * innovation.whiten.transpose();
      still_p_ += w * innovation.whitened;
      still_pp_ -= w * w.transpose();
    } else {
      moving_[i - 1].update(innovation);
    }
    log_likelihoods[i] = innovation.logLikelihood();
    best = std::max(best, log_likelihoods[i]);
  }
  double sum = 0.0;
  for (int i = 0; i < kModels; ++i) {
    if (weights_[i] > 0.0)
      weights_[i] *= std::exp(log_likelihoods[i] - best);
    sum += weights_[i];
  }
  for (double& weight : weights_)
    weight /= sum;
}

Vector3 MotionFilter::position() const {
  Vector3 mean = weights_[kStill] * still_p_;
  for (int i = 0; i < 2; ++i)
    mean += weights_[i + 1] * moving_[i].p;
  return mean;
}

Matrix3 MotionFilter::positionCovariance() const {
  const Vector3 mean = position();
  const Vector3 offset = still_p_ - mean;
  Matrix3 covariance = weights_[kStill] * (still_pp_ + offset * offset.transpose());
  for (int i = 0; i < 2; ++i) {
    const Vector3 d = moving_[i].p - mean;
    covariance += weights_[i + 1] * (moving_[i].pp + d * d.transpose());
  }
  return covariance;
}

Vector3 MotionFilter::velocity() const {
  return weights_[kGentle] * moving_[0].v + weights_[kBrisk] * moving_[1].v;
}

Matrix3 MotionFilter::velocityCovariance() const {
  const Vector3 mean = velocity();
  Matrix3 covariance = weights_[kStill] * mean * mean.transpose();
  for (int i = 0; i < 2; ++i) {
    const Vector3 d = moving_[i].v - mean;
    covariance += weights_[i + 1] * (moving_[i].vv + d * d.transpose());
  }
  return covariance;
}

Matrix2 PixelPrediction::covariance() const {
  Vector2 mean = Vector2::Zero();
  for (const Component& c : components_) {
    if (c.weight > 0.0)
      mean += c.weight * c.offset;
  }
  Matrix2 covariance = Matrix2::Zero();
  for (const Component& c : components_) {
    if (!(c.weight > 0.0))
      continue;
    // (L^-1)^-1 by hand: whiten is a lower triangle.
    Matrix2 lower;
    lower << 1.0 / c.whiten(0, 0), 0.0, -c.whiten(1, 0) / (c.whiten(0, 0) * c.whiten(1, 1)),
        1.0 / c.whiten(1, 1);
    const Vector2 d = c.offset - mean;
    covariance += c.weight * (lower * lower.transpose() + d * d.transpose());
  }
  return covariance;
}

double PixelPrediction::squaredDistance(const Vector2& pixel) const {
  double least = std::numeric_limits<double>::quiet_NaN();
  for (const Component& c : components_) {
    if (!(c.weight > 0.0))
      continue;
    const double squared = (c.whiten * (pixel - pixel_ - c.offset)).squaredNorm();
    if (!(squared >= least))
      least = squared;
  }
  return least;
}

double PixelPrediction::logLikelihood(const Vector2& pixel) const {
  double terms[3];
  double best = -std::numeric_limits<double>::infinity();
  int count = 0;
  for (const Component& c : components_) {
    if (!(c.weight > 0.0))
      continue;
    const double squared = (c.whiten * (pixel - pixel_ - c.offset)).squaredNorm();
    terms[count] = std::log(c.weight * c.whiten(0, 0) * c.whiten(1, 1)) - 0.5 * squared;
    best = std::max(best, terms[count++]);
  }
  double sum = 0.0;
  for (int i = 0; i < count; ++i)
    sum += std::exp(terms[i] - best);
  return best + std::log(sum) - std::log(2.0 * M_PI);
}

}  // namespace wiimote_tracker::motion
