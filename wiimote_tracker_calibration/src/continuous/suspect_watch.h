#ifndef WIIMOTE_TRACKER_CALIBRATION_CONTINUOUS_SUSPECT_WATCH_H
#define WIIMOTE_TRACKER_CALIBRATION_CONTINUOUS_SUSPECT_WATCH_H

#include "capture/image.h"
#include "capture/rest_gravity.h"
#include "continuous/motion_window.h"
#include "health/alarm.h"
#include "health/drift_watch.h"

#include <wiimote_tracker_triangulation/geometry/rig.h>

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker::continuous {

/// When a camera is off, and how much motion that it and two others see it takes to solve it.
struct SuspectOptions {
  health::DriftOptions drift;
  MotionOptions motion;
};

/// What was seen since a camera is off.
struct Evidence {
  std::size_t camera = 0;  ///< As the rig counts them.
  bool new_clock = false;  ///< Its time offset is unknown since it reconnected.
  MotionImages images;
  std::optional<Eigen::Vector3d> gravity;  ///< Of the camera at rest, optical frame [m/s^2].
};

/// Waits for a single camera to contradict all others, which agree, or to reconnect with a new
/// clock; then collects images of motion. Nothing is collected while several cameras are off, while
/// nothing moves, or with two cameras.
class SuspectWatch {
 public:
  SuspectWatch(const geometry::Rig& rig, const SuspectOptions& options);

  /// One image of any camera; of one camera in the order of their stamps.
  /// @returns evidence, once there is enough, and again after more motion while the camera is off.
  std::optional<Evidence> add(const capture::Image& image);

  /// Whether this camera alone is off or has a new clock.
  bool isSuspect(const std::string& camera) const {
    return suspect_ && rig_.cameras[*suspect_].camera.name == camera;
  }

  /// Names of the cameras whose time offset is unknown, since they reconnected.
  std::vector<std::string> newClocks() const;

  /// A reading of a camera's accelerometer, optical frame [m/s^2].
  void addAcceleration(const std::string& camera, const Eigen::Vector3d& specific_force);

 private:
  void judge();
  /// The one camera with a new clock; without such cameras the one that contradicts the others.
  std::optional<std::size_t> onlySuspect() const;

  geometry::Rig rig_;
  health::DriftWatch watch_;
  std::vector<health::Alarm> alarms_;  // Per camera of the rig.
  std::vector<bool> new_clocks_;       // Per camera of the rig: the offset is for another epoch.
  std::optional<std::size_t> suspect_;
  // Since there is a suspect:
  MotionWindow motion_;
  capture::RestGravity gravity_;
};

}  // namespace wiimote_tracker::continuous

#endif  // WIIMOTE_TRACKER_CALIBRATION_CONTINUOUS_SUSPECT_WATCH_H
