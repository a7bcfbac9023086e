#ifndef WIIMOTE_TRACKER_CALIBRATION_PLACE_MEASURE_PLACE_H
#define WIIMOTE_TRACKER_CALIBRATION_PLACE_MEASURE_PLACE_H

#include "wiimote_tracker_calibration/capture/corner_capture.h"

#include <wiimote_tracker_triangulation/geometry/rig.h>

#include <Eigen/Core>

#include <string>
#include <vector>

namespace wiimote_tracker::place {

/// How one camera saw the LED.
struct PlaceView {
  std::string camera;
  Eigen::Vector2d residual;  ///< Pixel of the measured point less the one that was seen [px].
};

/// A still LED, measured with a rig.
struct MeasuredPlace {
  Eigen::Vector3d position;  ///< World [m].
  /// Of the pixels and of the calibration, all cameras correlated [m^2].
  Eigen::Matrix3d covariance;
  bool calibration_known = true;  ///< Otherwise the covariance is that of the pixels alone.
  std::vector<PlaceView> views;   ///< In the order of the rig.

  /// Whether the rays meet as well as pixels and calibration let expect (chi-squared, 99.9 %).
  bool rays_agree = true;
  /// Cameras of which leaving out one makes the others agree: one of these was moved, or sees
  /// another light. Often it is two that face each other. Empty: all agree, there are two cameras
  /// only, or no single camera is to blame.
  std::vector<std::string> suspects;
};

/// The place of a still LED by maximum likelihood from all cameras of the rig that saw it, as the
/// tracker measures it, before any correction of the volume.
/// @param seen cameras that the rig does not know are left out.
/// @param pixel_stddev of a captured place in an image, per axis [px, > 0]: what is left
/// of its noise and rounding after averaging.
/// @throws PlaceError: fewer than two cameras, or rays that do not determine a point.
MeasuredPlace measurePlace(const geometry::Rig& rig,
                           const capture::CapturedCorner& seen,
                           double pixel_stddev);

/// The same after the rig's correction of the volume, if there is one that belongs to it: as the
/// tracker publishes it. @throws remap::RemapError: a correction that cannot be used.
MeasuredPlace corrected(const geometry::Rig& rig, MeasuredPlace place);

}  // namespace wiimote_tracker::place

#endif  // WIIMOTE_TRACKER_CALIBRATION_PLACE_MEASURE_PLACE_H
