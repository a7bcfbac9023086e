#ifndef WIIMOTE_TRACKER_CALIBRATION_CONTINUOUS_CONTINUOUS_CALIBRATION_H
#define WIIMOTE_TRACKER_CALIBRATION_CONTINUOUS_CONTINUOUS_CALIBRATION_H

#include "capture/image.h"
#include "continuous/suspect_watch.h"
#include "recalibrate/recalibrate_camera.h"

#include <wiimote_tracker_triangulation/geometry/rig.h>

#include <Eigen/Core>

#include <optional>
#include <string>

namespace wiimote_tracker::continuous {

struct Options {
  // {{limit [px], window [s]}, samples to solve, samples to check}; there are 20 samples a second.
  SuspectOptions knock = {{3.0, 6.0}, 140, 60};    ///< Noticed in 6 s; 7 s solve it, 3 s check it.
  SuspectOptions drift = {{0.7, 60.0}, 600, 200};  ///< Noticed in 60 s; 30 s and 10 s.
  /// A new pose is proposed only if the camera's mean residual then is below this [px, > 0].
  double accepted = 0.7;
  /// A camera that seems farther from where it was is left alone: it was put elsewhere, or it sees
  /// a light that moves with the LED [m, > 0].
  double farthest = 0.2;
  recalibrate::Options recalibrate;
};

enum class Cause { kKnock, kDrift };

/// A rig in which one camera was solved again against the others, which are as they were.
struct Proposal {
  Cause cause;
  std::string camera;
  geometry::Rig rig;    ///< As recalibrate::Recalibration has it; solved_at: its last image.
  double moved = 0.0;   ///< [m]
  double turned = 0.0;  ///< [rad]
  /// Mean residual of the camera against the others with the rig before and with the new one, on
  /// images that were taken after those of the solution [px].
  double before = 0.0;
  double after = 0.0;
  std::string message;  ///< One sentence: what has changed, and how well it is known.
};

/// Finds from ordinary tracking of one LED where a camera is that no longer fits the others. A
/// deterministic function of the images and readings. The points that the other cameras see do not
/// move: the others are held, and hold the world. A new pose must also explain images that were
/// taken after those of its solution.
class ContinuousCalibration {
 public:
  ContinuousCalibration(const geometry::Rig& rig, const Options& options);

  /// One image of any camera; of one camera in the order of their stamps. Images of another device
  /// than was calibrated take no part. It may take some seconds when there is enough motion.
  std::optional<Proposal> add(const capture::Image& image);

  /// Whether this camera alone is off. A proposal for another one is out of date.
  bool isSuspect(const std::string& camera) const {
    return knock_.isSuspect(camera) || drift_.isSuspect(camera);
  }

  /// A reading of a camera's accelerometer, optical frame [m/s^2].
  void addAcceleration(const std::string& camera, const Eigen::Vector3d& specific_force);

 private:
  std::optional<Proposal> solve(Cause cause, const Evidence& evidence) const;

  geometry::Rig rig_;
  Options options_;
  SuspectWatch knock_;
  SuspectWatch drift_;
};

}  // namespace wiimote_tracker::continuous

#endif  // WIIMOTE_TRACKER_CALIBRATION_CONTINUOUS_CONTINUOUS_CALIBRATION_H
