#include "led_groups.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>

namespace wiimote_tracker::body {
namespace {

// Greatest standard deviation of an LED's predicted pixel [px]: with more, the LED could be any
// spot, also that of another LED. It is 1/8 of the distance to the nearest LED of the body, so that
// gates of four standard deviations just touch, within limits. A body beyond it is found by shape.
constexpr double kWidestShare = 1.0 / 8.0;
constexpr double kLeastWidest = 2.0;
constexpr double kWidest = 12.0;
constexpr double kFurtherLed = 2.0;  // cost of each LED beyond the first
// Of two merged LEDs, either has 1/4 to 3/4 of the brightness: the spot is distributed uniformly
// over half of the distance between them, with a standard deviation of 1/sqrt(48) of that distance.
constexpr double kPlaceBetween = 0.1443;

/// Whether no other LED of the body could be taken for this one. An error of the image's time moves
/// all of them alike.
bool isCertain(const LedPrediction& led,
               double nearest,
               const geometry::Camera& camera,
               double pixel_stddev) {
  const double pixels = nearest * camera.intrinsics.fx / led.depth;
  const double widest = std::clamp(kWidestShare * pixels, kLeastWidest, kWidest);
  return (led.covariance - led.noise).trace() + 2.0 * pixel_stddev * pixel_stddev <
         2.0 * widest * widest;
}

}  // namespace

double LedGroup::misfit(const Eigen::Vector2d& pixel) const {
  const Eigen::Vector2d innovation = pixel - prediction.pixel;
  return innovation.dot(prediction.covariance.inverse() * innovation);
}

double LedGroup::cost(const Eigen::Vector2d& pixel, double gate) const {
  const double squared = misfit(pixel);
  if (!(squared < gate))
    return std::numeric_limits<double>::infinity();
  return squared + std::log(prediction.covariance.determinant()) + kFurtherLed * (leds.size() - 1);
}

LedGroups::LedGroups(const PoseState& state,
                     const Constellation& constellation,
                     const geometry::Camera& camera,
                     const geometry::PixelNoise& noise,
                     double merging_distance,
                     double gate)
    : gate_(gate) {
  const std::size_t leds = constellation.leds.size();
  for (std::size_t i = 0; i < leds; ++i) {
    singles_[i] = predictLed(state, camera, constellation.leds[i], noise);
    if (singles_[i] && !isCertain(*singles_[i], distanceToNearest(constellation.leds, i), camera,
                                  noise.pixel_stddev))
      singles_[i].reset();
  }
  const auto areNear = [&](std::size_t a, std::size_t b) {
    return (singles_[a]->pixel - singles_[b]->pixel).squaredNorm() <
           merging_distance * merging_distance;
  };
  for (std::size_t i = 0; i < leds; ++i) {
    if (!singles_[i])
      continue;
    LedGroup::Leds all{i};
    add(state, all);
    for (std::size_t k = 0; k < leds; ++k) {
      if (k == i || !singles_[k] || !areNear(i, k))
        continue;
      all.push_back(k);
      if (k > i)
        add(state, {i, k});
    }
    if (all.size() > 2)
      add(state, all);
  }
}

void LedGroups::add(const PoseState& state, const LedGroup::Leds& leds) {
  LedGroup& group = groups_.emplace_back();
  group.leds = leds;
  group.prediction = *singles_[leds[0]];
  if (leds.size() == 1)
    return;
  LedPrediction& mean = group.prediction;
  for (std::size_t i = 1; i < leds.size(); ++i) {
    mean.pixel += singles_[leds[i]]->pixel;
    mean.noise += singles_[leds[i]]->noise;
    mean.jacobian += singles_[leds[i]]->jacobian;
    mean.depth += singles_[leds[i]]->depth;
  }
  const auto count = static_cast<double>(leds.size());
  mean.pixel /= count;
  mean.noise /= count;
  mean.jacobian /= count;
  mean.depth /= count;
  double farthest = 0.0;
  for (const std::size_t led : leds)
    farthest = std::max(farthest, (singles_[led]->pixel - mean.pixel).norm());
  mean.noise.diagonal().array() += std::pow(kPlaceBetween * 2.0 * farthest, 2);
  mean.covariance = mean.noise + mean.jacobian * state.poseCovariance() * mean.jacobian.transpose();
}

double LedGroups::cost(std::size_t led, const Eigen::Vector2d& pixel) const {
  const LedGroup* group = best(led, pixel, {});
  return group ? group->cost(pixel, gate_) : std::numeric_limits<double>::infinity();
}

const LedGroup* LedGroups::best(std::size_t led,
                                const Eigen::Vector2d& pixel,
                                const std::array<bool, kMaximumLeds>& has_spot) const {
  const LedGroup* best = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (const LedGroup& group : groups_) {
    const LedGroup::Leds& leds = group.leds;
    const bool is_of_led = std::find(leds.begin(), leds.end(), led) != leds.end();
    const bool is_free = std::all_of(leds.begin(), leds.end(), [&](std::size_t other) {
      return other == led || !has_spot[other];
    });
    if (!is_of_led || !is_free)
      continue;
    const double cost = group.cost(pixel, gate_);
    if (cost < least) {
      least = cost;
      best = &group;
    }
  }
  return best;
}

}  // namespace wiimote_tracker::body
