#pragma once

#include "capture/corner_capture.h"

#include <wiimote_tracker_triangulation/geometry/rig.h>

#include <Eigen/Core>

#include <string>
#include <vector>

namespace wiimote_tracker::place {

/// The residual of one camera.
struct CameraResidual {
  std::string camera;
  Eigen::Vector2d residual;  ///< Pixel of the measured point less the observed one [px].
};

/// A still LED, measured with a rig.
struct MeasuredPlace {
  Eigen::Vector3d position;  ///< World [m].
  /// From the pixels and the calibration, whose cameras are correlated [m^2].
  Eigen::Matrix3d covariance;
  bool calibration_known = true;          ///< If not, the covariance is that of the pixels alone.
  std::vector<CameraResidual> residuals;  ///< In the order of the rig.

  /// Whether pixels and calibration explain how far the rays miss each other (chi-squared, 99.9 %).
  bool rays_agree = true;
  /// Cameras whose removal makes the others agree: one of them was moved, or sees another light.
  /// Empty: all agree, there are only two cameras, or no single camera explains it.
  std::vector<std::string> suspects;
  std::string remedy;  ///< How to calibrate such a camera again.
};

/// Triangulates a still LED by maximum likelihood from all cameras of the rig that saw it, as the
/// tracker does, without the correction of the volume.
/// @param seen cameras that the rig does not know are left out.
/// @param pixel_stddev of an averaged spot, per axis [px, > 0].
/// @throws Error: fewer than two cameras, or rays that do not determine a point.
MeasuredPlace measurePlace(const geometry::Rig& rig,
                           const capture::CapturedCorner& seen,
                           double pixel_stddev);

/// The place after the rig's correction of the volume, if it has a valid one. @throws
/// Error: a correction that cannot be used.
MeasuredPlace corrected(const geometry::Rig& rig, MeasuredPlace place);

}  // namespace wiimote_tracker::place
