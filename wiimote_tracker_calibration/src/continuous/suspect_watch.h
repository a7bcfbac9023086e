#pragma once

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

/// When a camera is off, and how much motion it takes to solve it.
struct SuspectOptions {
  health::DriftOptions drift;
  MotionOptions motion;             ///< That a single suspect and two others see.
  MotionOptions motion_of_several;  ///< While several are off.
};

/// What was seen since cameras are off.
struct Evidence {
  std::optional<std::size_t> camera;  ///< As the rig counts them; nothing: several are off.
  bool new_clock = false;             ///< Its time offset is unknown since it reconnected.
  bool has_turned = false;            ///< Farther than it drifts, perhaps about its optical axis.
  MotionImages images;
  /// Of each camera of the rig at rest, optical frame [m/s^2].
  std::vector<std::optional<Eigen::Vector3d>> gravity;
};

/// Waits for cameras to contradict the others, or for one to reconnect with a new clock; then
/// collects images of motion. Nothing is collected while nothing moves, or with two cameras.
class SuspectWatch {
 public:
  SuspectWatch(const geometry::Rig& rig, const SuspectOptions& options);

  /// One image of any camera; of one camera in the order of their stamps.
  /// @returns evidence, once there is enough, and again after more motion while cameras are off.
  std::optional<Evidence> add(const capture::Image& image);

  bool severalAreSuspect() const { return suspects_.size() > 1; }

  /// Whether this camera alone is off or has a new clock; of two or more: whether several are off.
  bool areSuspect(const std::vector<std::string>& cameras) const;

  /// Names of the cameras whose time offset is unknown, since they reconnected.
  std::vector<std::string> newClocks() const;

  /// A reading of a camera's accelerometer, optical frame [m/s^2].
  void addAcceleration(const std::string& camera, const Eigen::Vector3d& specific_force);

 private:
  void judge();
  /// The one camera with a new clock; without such cameras those that contradict the others.
  std::vector<std::size_t> suspects() const;

  geometry::Rig rig_;
  SuspectOptions options_;
  health::DriftWatch watch_;
  std::vector<health::Alarm> alarms_;  // Per camera of the rig.
  std::vector<bool> new_clocks_;       // Per camera of the rig: it reconnected.
  std::vector<std::size_t> suspects_;
  // Since there are suspects:
  MotionWindow motion_;
  std::vector<capture::RestGravity> gravity_;  // Per camera of the rig.
};

}  // namespace wiimote_tracker::continuous
