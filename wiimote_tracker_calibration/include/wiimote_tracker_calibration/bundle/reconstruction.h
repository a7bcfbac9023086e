#pragma once

#include <wiimote_tracker_msgs/error.h>
#include <wiimote_tracker_triangulation/geometry/camera.h>

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <vector>

namespace wiimote_tracker::bundle {

/// The observations do not determine the cameras. what() is one sentence that says what to do.
struct BundleError : Error {
  using Error::Error;
};

/// The pixel of one point in one camera.
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
  std::vector<bool> inliers;  ///< For each observation.
  std::vector<bool> placed;   ///< For each camera, while they are placed one after the other.
  bool converged = true;      ///< Whether the last adjust() ended at a solution.
};

/// Distance from the projected point to the observed pixel [px]. Nothing when the point is not
/// determined or not in front of the camera.
std::optional<double> reprojectionError(const Reconstruction& reconstruction,
                                        const Observation& observation);

/// Triangulates all points from the present cameras and marks the inliers: observations within
/// maximum_error [px] of a point that at least two cameras agree on. Of several such points it
/// takes the one with the most inliers, then with the smallest error. The rays of a point must meet
/// at an angle of at least 0.02 rad.
/// @param usable observations of cameras without usable[camera] are outliers; empty: all are
/// usable.
void triangulatePoints(Reconstruction* reconstruction,
                       double maximum_error,
                       const std::vector<bool>& usable = {});

}  // namespace wiimote_tracker::bundle
