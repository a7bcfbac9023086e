#pragma once

#include "wiimote_tracker_triangulation/geometry/rig.h"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace wiimote_tracker::geometry {

/// Covariance of a point due to the calibration's errors: D C D^T, with the joint covariance C of
/// the rig's parameters and D of pointSensitivity(). C holds errors that all cameras share, such as
/// a wrong length of the square.
///
/// This error is systematic: the same in every image of a rig, and nearly the same for neighbouring
/// points. It does not average out over images. Add it to the covariance from pixel noise to get
/// the covariance of the position in the world. It hardly affects velocities and distances of
/// neighbouring points. Errors of time offsets, which shift moving points, are not included.
class CalibrationUncertainty {
 public:
  static constexpr std::size_t kMaximumCameras = 16;  ///< Of a point; more are left out.

  explicit CalibrationUncertainty(const Rig& rig);

  /// Covariance [m^2] of a point seen by these cameras of the rig (ascending). Nothing when the rig
  /// has no covariance, or the cameras do not determine the point.
  std::optional<Eigen::Matrix3d> covarianceOf(const Eigen::Vector3d& point,
                                              const std::size_t* cameras,
                                              std::size_t count) const;

  /// The same for the centre of the point's cell of 0.2 m, cached: a few percent off, and some
  /// hundred times as fast for a cached cell. The result depends on the arguments only. Does not
  /// allocate.
  std::optional<Eigen::Matrix3d> covarianceNear(const Eigen::Vector3d& point,
                                                const std::size_t* cameras,
                                                std::size_t count);

 private:
  struct Cell {
    bool known = false;
    std::array<std::int32_t, 3> place;
    std::size_t count;
    std::array<std::uint16_t, kMaximumCameras> cameras;
    std::optional<Eigen::Matrix3d> covariance;
  };

  Rig rig_;
  std::vector<Cell> cells_;  // a hash table in which a new cell overwrites that of the same hash
};

}  // namespace wiimote_tracker::geometry
