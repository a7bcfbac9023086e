#ifndef WIIMOTE_TRACKER_CALIBRATION_RECALIBRATE_RECALIBRATE_CAMERA_H
#define WIIMOTE_TRACKER_CALIBRATION_RECALIBRATE_RECALIBRATE_CAMERA_H

#include "wiimote_tracker_calibration/capture/image.h"
#include "wiimote_tracker_calibration/square/rig_model.h"

#include <wiimote_tracker_triangulation/geometry/rig.h>

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker::recalibrate {

/// One camera of a rig that was moved or replaced, and an LED that was waved before all of them.
struct Request {
  std::string camera;
  std::string identity;  ///< Of the device that is there now; empty: unknown.
  /// Its starting values, when it is another device than was calibrated.
  geometry::Intrinsics intrinsics;
  std::optional<Eigen::Vector3d> gravity;  ///< As it reads now, optical frame [m/s^2].
  std::vector<capture::Image> images;      ///< Of each camera in the order of their stamps.
};

struct Options {
  square::Uncertainty uncertainty;        ///< Of the starting values of another device's lens.
  double pixel = 0.5;                     ///< Of a moving spot, per axis [px, > 0]; estimated.
  double stamp = 0.0003;                  ///< Error of a stamp, settling in 2 s [s, >= 0].
  double maximum_offset_stddev = 0.0005;  ///< A result less certain of the offset is refused [s].
};

/// The rig with the camera as it is now.
struct Recalibration {
  /// The other cameras are as they were, and so are the square, the zones and the correction of the
  /// volume, which is void from now on. Without solved_at. The covariance is joint: what the
  /// others' errors do to the camera is in it.
  geometry::Rig rig;
  double moved = 0.0;            ///< From where it was calibrated [m].
  double turned = 0.0;           ///< [rad]
  double position_stddev = 0.0;  ///< Root of the trace [m].
  double rotation_stddev = 0.0;  ///< Root of the trace [rad].
  double offset_stddev = 0.0;    ///< [s]
  std::size_t images = 0;        ///< Of the camera, that the LED was found in.
  std::string message;           ///< One sentence: how far it moved, how sure that is.
};

/// Solves one camera against the others, which stay where they are: pose, lens, time offset (most
/// probable values by Levenberg-Marquardt). The LED is where the others see it at the camera's own
/// times, between their images. The lens starts from the rig's and its covariance, or with another
/// device from the request. Wrong spots are left out.
/// @throws RecalibrateError: the rig does not have the camera, or fewer than two others that saw
/// the LED; too few images in common; an LED that hardly moved, or in a plane; the others
/// contradict each other, or the camera's images all of them; a result that is too uncertain; a
/// rig with RayModel::kImageCenter. Values out of range.
Recalibration recalibrateCamera(const geometry::Rig& rig,
                                const Request& request,
                                const Options& options);

}  // namespace wiimote_tracker::recalibrate

#endif  // WIIMOTE_TRACKER_CALIBRATION_RECALIBRATE_RECALIBRATE_CAMERA_H
