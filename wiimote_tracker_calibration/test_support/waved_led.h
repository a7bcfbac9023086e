#pragma once

#include "simulated_rig.h"
#include "wiimote_tracker_calibration/simulation/simulated_wave.h"

#include "capture/image.h"

#include <wiimote_tracker_triangulation/geometry/rig.h>
#include <wiimote_tracker_triangulation/geometry/so3.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace wiimote_tracker {

/// An LED, or several, that are waved before true cameras, each of which takes its images at its
/// own times.
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

  /// Where the LEDs are at a time [s], world [m].
  std::vector<Eigen::Vector3d> places(double time) const {
    if (still)
      return {*still};
    std::vector<Eigen::Vector3d> leds = {path.position(time, 0)};
    for (const wave::SimulatedPath& other : others)
      leds.push_back(other.position(time, 0));
    const Eigen::Vector3d turn =
        body_turn * Eigen::Vector3d(std::sin(1.1 * time), std::sin(0.8 * time + 1.0),
                                    std::sin(0.6 * time + 2.0));
    for (const Eigen::Vector3d& led : body)
      leds.push_back(leds.front() + geometry::so3::exp(turn) * led);
    return leds;
  }

  /// So many LEDs: of as many persons, or 10 to 20 cm apart on one body.
  void shine(std::size_t leds, bool on_body) {
    if (leds < 2)
      return;
    const std::vector<Eigen::Vector3d> kOnBody = {
        {0.15, 0.0, 0.0}, {0.02, 0.14, 0.03}, {0.04, 0.05, 0.17}};
    square::Random random(random_());
    while (places(0.0).size() < leds) {
      if (on_body)
        body.push_back(kOnBody[body.size()]);
      else
        others.emplace_back(0.0, random);
    }
  }

  /// In the order of the pixels, which tells of no LED. Lights nearer than this are one spot, of
  /// which a camera reports four at most.
  static void addSpot(const Eigen::Vector2d& spot, capture::Blobs* spots) {
    constexpr double kOneSpot = 16.0;  // [px]
    const Eigen::Vector2d pixel = spot.array().round();
    for (Eigen::Vector2d& other : *spots) {
      if ((other - pixel).norm() < kOneSpot) {
        other = (0.5 * (other + pixel)).array().round();
        return;
      }
    }
    if (spots->size() < 4)
      spots->insert(std::find_if(spots->begin(), spots->end(),
                                 [&](const auto& other) { return other.x() > pixel.x(); }),
                    pixel);
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

  std::vector<wave::SimulatedPath> others;  ///< Of LEDs of other persons.
  std::vector<Eigen::Vector3d> body;  ///< Further LEDs on a rigid body, seen from the first [m].
  double body_turn = 1.0;             ///< How far it turns about each axis [rad].
  double hidden = 0.0;  ///< Share of the half seconds in which a camera does not see an LED.
  double ghosts = 0.0;  ///< Share of the images with one spot more, anywhere.

 private:
  capture::Image imageOf(std::size_t index, double exposure) {
    const geometry::RigCamera& camera = truth[index];
    capture::Image image;
    image.camera = camera.camera.name;
    image.stamp = kClock + exposure - camera.time_offset + square::normal(random_, stamp);
    image.clock_epoch = epoch;
    const std::vector<Eigen::Vector3d> leds = places(exposure);
    for (std::size_t led = 0; led < leds.size(); ++led) {
      const auto seen = camera.camera.project(leds[led]);
      if (!seen || (leds.size() > 1 && !camera.camera.sees(leds[led])) ||
          isHidden(index, led, exposure))
        continue;
      Eigen::Vector2d spot =
          *seen + Eigen::Vector2d(square::normal(random_, pixel), square::normal(random_, pixel));
      if (square::uniform(random_, 0.0, 1.0) < wrong_share)
        spot = anywhere();
      addSpot(spot, &image.spots);
    }
    if (ghosts > 0.0 && square::uniform(random_, 0.0, 1.0) < ghosts)
      addSpot(anywhere(), &image.spots);
    return image;
  }

  Eigen::Vector2d anywhere() {
    return {square::uniform(random_, 0.0, 1023.0), square::uniform(random_, 0.0, 767.0)};
  }

  bool isHidden(std::size_t camera, std::size_t led, double exposure) const {
    constexpr double kHiddenFor = 0.5;  // [s]
    if (hidden == 0.0)
      return false;
    square::Random random(10000 * static_cast<std::uint64_t>(exposure / kHiddenFor) + 100 * led +
                          camera);
    return square::uniform(random, 0.0, 1.0) < hidden;
  }

 public:
  /// Stamps are as large as those of the system's clock [s].
  static constexpr double kClock = 1.7e9;

 private:
  double period_;
  std::vector<double> next_;
};

}  // namespace wiimote_tracker
