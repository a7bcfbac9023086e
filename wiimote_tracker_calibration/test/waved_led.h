#ifndef WIIMOTE_TRACKER_CALIBRATION_TEST_WAVED_LED_H
#define WIIMOTE_TRACKER_CALIBRATION_TEST_WAVED_LED_H

#include "simulated_rig.h"
#include "wiimote_tracker_calibration/simulation/simulated_wave.h"

#include "capture/image.h"

#include <wiimote_tracker_triangulation/geometry/rig.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace wiimote_tracker {

/// An LED that is waved before true cameras, each of which takes its images at its own times.
class WavedLed {
 public:
  WavedLed(std::vector<geometry::RigCamera> cameras, std::uint64_t seed, double rate = 50.0)
      : truth(std::move(cameras)), path(0.0, random_), period_(1.0 / rate) {
    random_.seed(seed);
    path = wave::SimulatedPath(0.0, random_);
    for (std::size_t i = 0; i < truth.size(); ++i)
      next_.push_back(square::uniform(random_, 0.0, period_));
  }

  /// Images up to a time, in its order.
  template <typename OnImage>
  void runUntil(double time, const OnImage& on_image) {
    while (true) {
      const auto first = std::min_element(next_.begin(), next_.end());
      if (*first >= time)
        return;
      on_image(imageOf(static_cast<std::size_t>(first - next_.begin()), *first));
      *first += period_;
    }
  }

  /// Leaves out the images before a time [s].
  void skipTo(double time) {
    for (double& next : next_)
      next += period_ * std::max(0.0, std::ceil((time - next) / period_));
  }

 private:
  square::Random random_;

 public:
  std::vector<geometry::RigCamera> truth;
  wave::SimulatedPath path;
  double wrong_share = 0.05;  ///< Of the spots that are anywhere in the image instead.
  double pixel = 0.4;         ///< Noise before rounding [px].
  double stamp = 0.0;         ///< Error of each stamp [s].
  std::uint32_t epoch = 7;
  std::optional<Eigen::Vector3d> still;  ///< The LED lies there.

 private:
  capture::Image imageOf(std::size_t index, double exposure) {
    const geometry::RigCamera& camera = truth[index];
    capture::Image image;
    image.camera = camera.camera.name;
    image.stamp = kClock + exposure - camera.time_offset + square::normal(random_, stamp);
    image.clock_epoch = epoch;
    const Eigen::Vector3d led = still ? *still : path.position(exposure, 0);
    const auto seen = camera.camera.project(led);
    if (!seen)
      return image;
    Eigen::Vector2d spot =
        *seen + Eigen::Vector2d(square::normal(random_, pixel), square::normal(random_, pixel));
    if (square::uniform(random_, 0.0, 1.0) < wrong_share)
      spot = {square::uniform(random_, 0.0, 1023.0), square::uniform(random_, 0.0, 767.0)};
    image.spots.emplace_back(std::round(spot.x()), std::round(spot.y()));
    return image;
  }

 public:
  /// Stamps are as large as those of the system's clock [s].
  static constexpr double kClock = 1.7e9;

 private:
  double period_;
  std::vector<double> next_;
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_CALIBRATION_TEST_WAVED_LED_H
