#ifndef WIIMOTE_TRACKER_CALIBRATION_HEALTH_TILT_WATCH_H
#define WIIMOTE_TRACKER_CALIBRATION_HEALTH_TILT_WATCH_H

#include "wiimote_tracker_calibration/capture/rest_gravity.h"

#include <Eigen/Core>

#include <optional>

namespace wiimote_tracker::health {

struct TiltOptions {
  double limit = 0.02;   ///< Angle that is no longer taken for nothing [rad, > 0].
  double window = 10.0;  ///< Readings are averaged over this long [s, > 0].
  /// Step of the accelerometer, per axis [m/s^2, >= 0]: a camera at rest may read the same number
  /// for ever, so that averaging does not help. A Wii Remote's y and z count in steps of two, of
  /// which 54 are 1 g.
  double resolution = 0.18;
};

/// How far a camera is turned against where it stood when it was calibrated. Turns about the
/// vertical cannot be seen.
struct Tilt {
  double angle = 0.0;   ///< [rad]
  double stddev = 0.0;  ///< Of the angle, in each direction [rad].
  double ratio = 0.0;   ///< Angle over what is tolerated: the limit, or three stddev if more [1].
};

/// Compares what a camera's accelerometer reads at rest with what it read at calibration.
class TiltWatch {
 public:
  /// @param gravity specific force at calibration, optical frame [m/s^2, not zero].
  TiltWatch(const Eigen::Vector3d& gravity, const TiltOptions& options)
      : gravity_(gravity), options_(options) {}

  /// One reading, optical frame [m/s^2]. A time before the last one starts the window anew.
  /// @returns a judgement at the end of each window; nothing when the camera was shaken
  /// or gave too few readings (RestGravity::mean()).
  std::optional<Tilt> add(double time, const Eigen::Vector3d& specific_force);

 private:
  std::optional<Tilt> judge() const;

  Eigen::Vector3d gravity_;
  TiltOptions options_;
  bool started_ = false;
  double start_ = 0.0;
  double last_ = 0.0;
  capture::RestGravity window_;
};

}  // namespace wiimote_tracker::health

#endif  // WIIMOTE_TRACKER_CALIBRATION_HEALTH_TILT_WATCH_H
