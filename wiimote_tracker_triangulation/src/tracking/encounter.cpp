#include "encounter.h"

#include <algorithm>
#include <cmath>

namespace wiimote_tracker::tracking {
namespace {

constexpr double kLeastLogLikelihood = -20.0;  // [log 1/px^2]; one bad spot does not decide
constexpr double kCertain = 7.0;               // log of 1000 to 1
constexpr double kLongestDoubt = 0.25;         // [s]

/// Log likelihood of the pixel, which is taken in.
double follow(motion::MotionFilter* filter,
              const geometry::Camera& camera,
              const motion::PixelNoise& noise,
              double time,
              const Eigen::Vector2d& pixel) {
  filter->predict(time);
  const auto prediction = filter->predictPixel(camera, noise);
  if (!prediction)
    return kLeastLogLikelihood;
  const double result = prediction->logLikelihood(pixel);
  filter->update(camera, *prediction, pixel);
  return std::isfinite(result) ? std::max(result, kLeastLogLikelihood) : kLeastLogLikelihood;
}

}  // namespace

motion::MotionFilter Encounter::motionOf(std::size_t which, double time) const {
  motion::MotionFilter result = other_way_[which];
  result.predict(time);
  return result;
}

void Encounter::take(const geometry::Camera& camera,
                     const motion::PixelNoise& noise,
                     const Pixels& pixels,
                     const std::array<motion::MotionFilter*, 2>& filters) {
  const double time = filters[0]->time();
  if (!has_parted_) {
    has_parted_ = true;
    parted_at_ = time;
    for (std::size_t i = 0; i < 2; ++i)
      *filters[i] = motionOf(i, time);
  }
  for (std::size_t i = 0; i < 2; ++i) {
    gain_ -= follow(filters[i], camera, noise, time, pixels[i]);
    gain_ += follow(&other_way_[i], camera, noise, time, pixels[1 - i]);
  }
}

bool Encounter::decide(double time, const std::array<motion::MotionFilter*, 2>& filters) const {
  if (!has_parted_ || (std::fabs(gain_) < kCertain && time < parted_at_ + kLongestDoubt))
    return false;
  if (gain_ > 0.0) {
    for (std::size_t i = 0; i < 2; ++i)
      *filters[i] = motionOf(i, time);
  }
  return true;
}

}  // namespace wiimote_tracker::tracking
