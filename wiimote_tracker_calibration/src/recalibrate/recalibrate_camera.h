#pragma once

#include "capture/image.h"
#include "wiimote_tracker_calibration/wave/solve_wave.h"

#include <wiimote_tracker_triangulation/geometry/rig.h>

#include <Eigen/Core>

#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker::recalibrate {

/// One camera of a rig that was moved or replaced, or a new one, and images of an LED waved in
/// front of all.
struct Request {
  std::string camera;
  std::string identity;  ///< Of the device that is there now; empty: unknown.
  /// Its starting values, when it is new or another device than was calibrated.
  geometry::Intrinsics intrinsics;
  std::optional<Eigen::Vector3d> gravity;  ///< As it reads now, optical frame [m/s^2].
  /// Of each camera in the order of their stamps. Those of the camera's latest epoch are used.
  std::vector<capture::Image> images;
};

/// As of a wave of all cameras: pixel, wander, maximum_offset_stddev, and uncertainty, here of the
/// starting values of another device's lens.
using Options = wave::WaveOptions;

/// The rig with the camera as it is now. A new one comes last.
struct Recalibration {
  /// The other cameras, square and zones are unchanged. The correction of the volume is unchanged,
  /// too, but no longer valid. Without solved_at. The covariance is joint: it includes the errors
  /// of the others.
  geometry::Rig rig;
  double moved = 0.0;            ///< From where it was calibrated [m]; 0 for a new one.
  double turned = 0.0;           ///< [rad]
  double position_stddev = 0.0;  ///< Root of the trace [m].
  double rotation_stddev = 0.0;  ///< Root of the trace [rad].
  double offset_stddev = 0.0;    ///< [s]
  std::string message;           ///< One sentence: how far it moved, how sure that is.
};

/// Why no recording could solve a camera of this rig, or one to be added, and what to do; empty:
/// one may.
std::string whyUnsolvable(const geometry::Rig& rig,
                          const std::string& camera,
                          const Options& options);

/// Estimates pose, lens and time offset of one camera, the others being fixed: maximum a posteriori
/// by Levenberg-Marquardt. The LED's positions are triangulated from the others, interpolated to
/// the camera's times. The prior of the lens is the rig's lens with its covariance, or the
/// request's for a new camera and another device. False detections are left out by gating.
/// @throws Error: the camera sent no images, or fewer than two others saw the LED; too
/// few common images; an LED that hardly moved, or in a plane only; contradictory images; a result
/// that is too uncertain; what whyUnsolvable() says.
Recalibration recalibrateCamera(const geometry::Rig& before,
                                const Request& request,
                                const Options& options);

}  // namespace wiimote_tracker::recalibrate
