#ifndef WIIMOTE_TRACKER_CALIBRATION_CONTINUOUS_SUSPECT_WATCH_H
#define WIIMOTE_TRACKER_CALIBRATION_CONTINUOUS_SUSPECT_WATCH_H

#include "capture/image.h"
#include "capture/rest_gravity.h"
#include "health/alarm.h"
#include "health/drift_watch.h"

#include <wiimote_tracker_triangulation/geometry/rig.h>

#include <Eigen/Core>

#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker::continuous {

/// When a camera is off, and how much motion it takes to solve it. Motion is counted in samples of
/// health::DriftWatch, at most 20 a second, in which the camera and two others see the LED.
struct SuspectOptions {
  health::DriftOptions drift;
  std::size_t to_solve = 0;  ///< Samples [> 0].
  /// Later samples, which the solution does not use [>= 40: fewer are not judged, see meanOf() in
  /// health/drift_residuals.h].
  std::size_t to_check = 0;
};

/// What was seen since a camera is off.
struct Evidence {
  std::string camera;
  std::vector<capture::Image> to_solve;    ///< Of all cameras.
  std::vector<capture::Image> to_check;    ///< Of all cameras, later.
  std::optional<Eigen::Vector3d> gravity;  ///< Of the camera at rest, optical frame [m/s^2].
};

/// Waits for a single camera to contradict all others, which agree; then collects images of motion.
/// Nothing is collected while several cameras are off, while nothing moves, or with two cameras.
class SuspectWatch {
 public:
  SuspectWatch(const geometry::Rig& rig, const SuspectOptions& options);

  /// One image of any camera; of one camera in the order of their stamps.
  /// @returns evidence, once there is enough, and again after more motion while the camera is off.
  std::optional<Evidence> add(const capture::Image& image);

  /// Whether this camera alone is off.
  bool isSuspect(const std::string& camera) const {
    return suspect_ && names_[*suspect_] == camera;
  }

  /// A reading of a camera's accelerometer, optical frame [m/s^2].
  void addAcceleration(const std::string& camera, const Eigen::Vector3d& specific_force);

 private:
  void judge();
  /// Forgets what was collected, and begins to collect for this camera.
  void collectFor(std::optional<std::size_t> suspect);
  /// Counts the newest sample, if the suspect takes part in it; begins again if time jumped back.
  /// @returns whether there was such a sample shortly before this time [s].
  bool countMotion(double time);
  void forgetSurplus();
  Evidence evidence() const;

  SuspectOptions options_;
  std::vector<std::string> names_;
  health::DriftWatch watch_;
  std::vector<health::Alarm> alarms_;  // Per camera of the rig.
  std::optional<std::size_t> suspect_;
  // Since there is a suspect:
  std::deque<capture::Image> images_;  // While the LED moves.
  std::deque<double> motion_;          // Times of the samples [s].
  std::size_t unused_ = 0;             // Samples since the last evidence.
  capture::RestGravity gravity_;
};

}  // namespace wiimote_tracker::continuous

#endif  // WIIMOTE_TRACKER_CALIBRATION_CONTINUOUS_SUSPECT_WATCH_H
