#pragma once

#include "capture/rest_gravity.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace wiimote_tracker::health {

struct TiltOptions {
  double limit = 0.02;   ///< Largest tilt of a camera that did not move [rad, > 0].
  double window = 10.0;  ///< Readings are averaged over this long [s, > 0].
  /// Resolution of the accelerometer, per axis [m/s^2, >= 0]. Averaging does not improve it: a
  /// camera at rest may always read the same number. A Wii Remote's y and z have 54 steps per g.
  double resolution = 0.18;
};

/// How far a camera has turned since its calibration. Rotations about the vertical are not
/// observable.
struct Tilt {
  double angle = 0.0;   ///< [rad]
  double stddev = 0.0;  ///< Of the angle, in each direction [rad].
  double ratio = 0.0;   ///< Angle over the tolerance: the larger of the limit and three stddev [1].
};

/// @param before, now specific force at rest, at calibration and lately, optical frame [m/s^2, not
/// zero].
inline Tilt tiltOf(const Eigen::Vector3d& before,
                   const Eigen::Vector3d& now,
                   const TiltOptions& options) {
  Tilt tilt;
  tilt.angle = std::atan2(before.cross(now).norm(), before.dot(now));
  // Rounding, at calibration and now. Averaged noise is far smaller.
  tilt.stddev = options.resolution / std::sqrt(12.0) * std::sqrt(2.0) / before.norm();
  tilt.ratio = tilt.angle / std::max(options.limit, 3.0 * tilt.stddev);
  return tilt;
}

/// Compares a camera's accelerometer at rest with its readings at calibration.
class TiltWatch {
 public:
  /// @param gravity specific force at calibration, optical frame [m/s^2, not zero].
  TiltWatch(const Eigen::Vector3d& gravity, const TiltOptions& options)
      : gravity_(gravity), options_(options) {}

  /// One reading, optical frame [m/s^2]. A time before the last one starts the window again.
  /// @returns a judgement at the end of each window; nothing when the camera was shaken
  /// or gave too few readings (RestGravity::mean()).
  std::optional<Tilt> add(double time, const Eigen::Vector3d& specific_force) {
    std::optional<Tilt> tilt;
    const bool is_over = time - start_ >= options_.window;
    if (time >= last_ && is_over) {
      if (const auto now = window_.mean())
        tilt = tiltOf(gravity_, *now, options_);
    }
    if (time < last_ || is_over) {
      start_ = time;
      window_ = capture::RestGravity();
    }
    last_ = time;
    window_.add(specific_force);
    return tilt;
  }

 private:
  Eigen::Vector3d gravity_;
  TiltOptions options_;
  double start_ = -std::numeric_limits<double>::infinity();  // Of the window [s].
  double last_ = start_;                                     // Reading [s].
  capture::RestGravity window_;
};

}  // namespace wiimote_tracker::health
