#pragma once

#include <wiimote_tracker_triangulation/geometry/rig.h>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cstddef>
#include <vector>

namespace wiimote_tracker::rooms {

/// Minimum width of shared places relative to their length: on a line they leave a rotation open.
constexpr double kThinnest = 0.05;

/// A camera, a place or the vertical that two rigs share. Derivatives are by all parameters of a
/// rig. Their rows are: of a camera the rotation, the position, then fx, fy, cx, cy; of a place the
/// position; of the vertical, which is the z axis of in_first and in_second, its components along
/// the x and y axes of in_first.
struct Shared {
  Eigen::Isometry3d in_first;   ///< [m]
  Eigen::Isometry3d in_second;  ///< [m]
  Eigen::MatrixXd by_first;
  Eigen::MatrixXd by_second;
  /// Of a place or the vertical: of in_second against in_first, along the axes of in_first, without
  /// the rigs' covariances [m; rad].
  Eigen::Vector3d stddevs = Eigen::Vector3d::Zero();
  /// Standard deviation of an error that all places share: of in_second against in_first, along the
  /// axes of the first world [m].
  Eigen::Vector3d common = Eigen::Vector3d::Zero();
  /// Of a camera: fx, fy, cx, cy of the second rig minus those of the first [px].
  Eigen::Vector4d lens_difference = Eigen::Vector4d::Zero();
};

/// The motion between two rigs that fits best to what they share.
struct RigMotion {
  Eigen::Isometry3d first_from_second;
  /// Its error (true minus estimated: rotation about the first world's axes, translation) by the
  /// errors of the parameters of the first rig, of the second, and of what they share.
  Eigen::MatrixXd by_errors;
  Eigen::MatrixXd error_covariance;  ///< Of these errors.
  double chi_squared = 0.0;
  int degrees_of_freedom = 0;

  /// Whether what they share contradicts itself (chi-squared test, 99.9 %).
  bool contradicts() const;
};

/// Generalised least squares, weighted by the covariances of both rigs.
/// @throws Error: what they share leaves the motion open.
RigMotion fitMotion(const geometry::Rig& first,
                    const geometry::Rig& second,
                    const std::vector<Shared>& shared,
                    const Eigen::Isometry3d& start);

/// Index of the shared camera or place without which the rest fits best.
std::size_t oddOneOut(const geometry::Rig& first,
                      const geometry::Rig& second,
                      const std::vector<Shared>& shared,
                      const Eigen::Isometry3d& start);

}  // namespace wiimote_tracker::rooms
