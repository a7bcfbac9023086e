#ifndef WIIMOTE_TRACKER_CALIBRATION_BUNDLE_RECONSTRUCTION_H
#define WIIMOTE_TRACKER_CALIBRATION_BUNDLE_RECONSTRUCTION_H

#include "wiimote_tracker_triangulation/geometry/camera.h"

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <vector>

namespace wiimote_tracker::bundle {

/// One camera saw one point.
struct Observation {
  std::size_t camera;     ///< Index into Reconstruction::cameras.
  std::size_t point;      ///< Index into Reconstruction::points.
  Eigen::Vector2d pixel;  ///< As observed, distorted [px].
};

/// Cameras and points, and the observations that tie them together.
struct Reconstruction {
  std::vector<geometry::Camera> cameras;
  std::vector<std::optional<Eigen::Vector3d>> points;  ///< World [m]; nothing: not determined.
  std::vector<Observation> observations;
  std::vector<bool> inliers;  ///< One per observation: it took part in the solution.
};

/// Distance from the projected point to the observed pixel [px]. Nothing when the point is not
/// determined or not in front of the camera.
std::optional<double> reprojectionError(const Reconstruction& reconstruction,
                                        const Observation& observation);

/// Computes every point anew from the cameras as they stand, and with it which observations are
/// inliers: those within maximum_error [px] of a point that at least two of them agree on. The
/// point with the most inliers wins, then the one with the smallest error.
/// Rays that meet under less than minimum_angle [rad] make no point. Only cameras with
/// usable[camera] take part; observations of the others become outliers.
void triangulatePoints(Reconstruction* reconstruction,
                       const std::vector<bool>& usable,
                       double maximum_error,
                       double minimum_angle);

}  // namespace wiimote_tracker::bundle

#endif  // WIIMOTE_TRACKER_CALIBRATION_BUNDLE_RECONSTRUCTION_H
