#include "wiimote_tracker_triangulation/identity/evidence.h"

#include <algorithm>
#include <cmath>

namespace wiimote_tracker::identity {

Evidence::Evidence(const Hypotheses& hypotheses)
    : hypotheses_(&hypotheses), sum_{Eigen::ArrayXf::Zero(hypotheses.cells())} {}

void Evidence::reset(double origin) {
  origin_ = origin;
  weight_ = 1.0;
  weight_origin_ = origin;
  sum_.cells.setZero();
  sum_.steady = 0.0;
  for (Darkness& darkness : darkness_)
    darkness.lasts = false;
}

double Evidence::weightAt(double time) {
  constexpr double kLargest = 1e3;
  double weight = std::exp((time - weight_origin_) / hypotheses_->memory());
  if (weight > kLargest) {
    const auto divide = [weight](LogLikelihoods* sum) {
      sum->cells *= static_cast<float>(1.0 / weight);
      sum->steady /= weight;
    };
    divide(&sum_);
    for (Darkness& darkness : darkness_) {
      darkness.weight /= weight;
      divide(&darkness.sum);
    }
    weight_origin_ = time;
    weight_ = weight = 1.0;
  }
  weight_ = std::max(weight_, weight);
  return weight;
}

void Evidence::accumulate(const Sighting& sighting, double weight, LogLikelihoods* sum) const {
  const Eigen::Index phases = hypotheses_->phases();
  const auto factor = static_cast<float>(weight);
  const double time = sighting.time - origin_;
  float* cell = sum->cells.data();
  for (const double frequency : hypotheses_->frequencies()) {
    const float* row = hypotheses_->rowsOf(sighting, frequency, time * frequency);
    for (std::size_t label = 0; label < hypotheses_->labels(); ++label) {
      Eigen::Map<Eigen::ArrayXf>(cell, phases) +=
          factor * Eigen::Map<const Eigen::ArrayXf>(row, phases);
      cell += phases;
      row += 2 * phases;
    }
  }
  sum->steady += weight * hypotheses_->steady(sighting.seen);
}

/// Adds the log likelihoods of a dark interval, none below that of an occlusion.
void Evidence::addLimited(const Darkness& darkness, LogLikelihoods* sum) const {
  const auto least = static_cast<float>(darkness.weight * std::log(kOccluded));
  sum->cells += darkness.sum.cells.max(least);
  sum->steady += std::max(darkness.sum.steady, static_cast<double>(least));
}

void Evidence::add(const Sighting& sighting) {
  while (darkness_.size() <= sighting.camera)
    darkness_.push_back({false, 1.0, {Eigen::ArrayXf::Zero(sum_.cells.size())}});
  const double weight = weightAt(sighting.time);
  Darkness& darkness = darkness_[sighting.camera];
  if (sighting.seen) {
    if (darkness.lasts)
      addLimited(darkness, &sum_);
    darkness.lasts = false;
    accumulate(sighting, weight, &sum_);
    return;
  }
  if (!darkness.lasts) {
    darkness.lasts = true;
    darkness.weight = weight;
    darkness.sum.cells.setZero();
    darkness.sum.steady = 0.0;
  }
  accumulate(sighting, weight, &darkness.sum);
}

void Evidence::read(LogLikelihoods* now) const {
  *now = sum_;
  for (const Darkness& darkness : darkness_) {
    if (darkness.lasts)
      addLimited(darkness, now);
  }
  now->cells *= static_cast<float>(1.0 / weight_);
  now->steady /= weight_;
}

}  // namespace wiimote_tracker::identity
