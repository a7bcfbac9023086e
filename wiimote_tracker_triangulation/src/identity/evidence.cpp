#include "wiimote_tracker_triangulation/identity/evidence.h"

#include <algorithm>
#include <cmath>

namespace wiimote_tracker::identity {

Evidence::Evidence(const Hypotheses& hypotheses)
    : hypotheses_(&hypotheses),
      cells_(Eigen::ArrayXf::Zero(static_cast<Eigen::Index>(hypotheses.cells()))) {}

void Evidence::reset(double origin) {
  origin_ = origin;
  weight_ = 1.0;
  weight_origin_ = origin;
  cells_.setZero();
  steady_ = 0.0;
  for (Darkness& darkness : darkness_)
    darkness.lasts = false;
}

double Evidence::weightAt(double time) {
  constexpr double kLargest = 1e3;
  double weight = std::exp((time - weight_origin_) / hypotheses_->memory());
  if (weight > kLargest) {
    const auto scale = static_cast<float>(1.0 / weight);
    cells_ *= scale;
    steady_ /= weight;
    for (Darkness& darkness : darkness_) {
      darkness.weight /= weight;
      darkness.steady /= weight;
      darkness.cells *= scale;
    }
    weight_origin_ = time;
    weight_ = weight = 1.0;
  }
  weight_ = std::max(weight_, weight);
  return weight;
}

void Evidence::accumulate(const Sighting& sighting,
                          double weight,
                          Eigen::ArrayXf* cells,
                          double* steady) {
  const auto phases = static_cast<Eigen::Index>(hypotheses_->phases());
  const auto factor = static_cast<float>(weight);
  const double time = sighting.time - origin_;
  float* cell = cells->data();
  for (const double frequency : hypotheses_->frequencies()) {
    const float* row = hypotheses_->rowsOf(sighting, frequency, time * frequency);
    for (std::size_t label = 0; label < hypotheses_->labels(); ++label) {
      Eigen::Map<Eigen::ArrayXf>(cell, phases) +=
          factor * Eigen::Map<const Eigen::ArrayXf>(row, phases);
      cell += phases;
      row += 2 * phases;
    }
  }
  *steady += weight * hypotheses_->steady(sighting.seen);
}

float Evidence::least(const Darkness& darkness) const {
  return static_cast<float>(darkness.weight * std::log(hypotheses_->seeing().hidden));
}

void Evidence::endDarkness(Darkness* darkness) {
  cells_ += darkness->cells.max(least(*darkness));
  steady_ += std::max(darkness->steady, static_cast<double>(least(*darkness)));
  darkness->lasts = false;
}

void Evidence::add(const Sighting& sighting) {
  while (darkness_.size() <= sighting.camera)
    darkness_.push_back({false, 1.0, Eigen::ArrayXf::Zero(cells_.size()), 0.0});
  const double weight = weightAt(sighting.time);
  Darkness& darkness = darkness_[sighting.camera];
  if (sighting.seen) {
    if (darkness.lasts)
      endDarkness(&darkness);
    accumulate(sighting, weight, &cells_, &steady_);
    return;
  }
  if (!darkness.lasts) {
    darkness.lasts = true;
    darkness.weight = weight;
    darkness.cells.setZero();
    darkness.steady = 0.0;
  }
  accumulate(sighting, weight, &darkness.cells, &darkness.steady);
}

void Evidence::read(Eigen::ArrayXf* cells, double* steady) const {
  *cells = cells_;
  *steady = steady_;
  for (const Darkness& darkness : darkness_) {
    if (!darkness.lasts)
      continue;
    *cells += darkness.cells.max(least(darkness));
    *steady += std::max(darkness.steady, static_cast<double>(least(darkness)));
  }
  *cells *= static_cast<float>(1.0 / weight_);
  *steady /= weight_;
}

}  // namespace wiimote_tracker::identity
