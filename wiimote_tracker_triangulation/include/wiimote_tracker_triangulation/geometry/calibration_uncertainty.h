#ifndef WIIMOTE_TRACKER_TRIANGULATION_GEOMETRY_CALIBRATION_UNCERTAINTY_H
#define WIIMOTE_TRACKER_TRIANGULATION_GEOMETRY_CALIBRATION_UNCERTAINTY_H

#include "wiimote_tracker_triangulation/geometry/rig.h"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace wiimote_tracker::geometry {

/// How far a point is off because the cameras are not quite where and what the rig says: D C D^T,
/// with the joint covariance C of the rig's parameters and D = d point / d parameters of the point
/// of maximum likelihood from the cameras that see it. What the cameras have in common, such as a
/// wrong length of the square, is in C and so in the result.
///
/// This error is systematic: it is the same in every image, for as long as the rig is, and nearly
/// the same for points side by side. It does not average out, and must not be divided by the number
/// of images. Added to the covariance of the pixels' noise, which does average out, it gives that
/// of the position in the world. Of a velocity, and of the distance of two near points, it is all
/// but nothing. Time offsets that are not exact shift what moves; they are not in it.
class CalibrationUncertainty {
 public:
  static constexpr std::size_t kMaximumCameras = 16;  ///< Of a point; more are left out.

  explicit CalibrationUncertainty(const Rig& rig);

  /// Whether the rig says how certain its cameras are. If not, there is no covariance anywhere.
  bool isKnown() const { return rig_.covariance.size() > 0; }

  /// Covariance [m^2] of a point seen by these cameras of the rig (ascending). Nothing when it is
  /// not known, or the cameras do not determine the point.
  std::optional<Eigen::Matrix3d> covarianceOf(const Eigen::Vector3d& point,
                                              const std::size_t* cameras,
                                              std::size_t count) const;

  /// The same, but of the middle of the cell of 0.2 m that the point is in, and remembered: some
  /// percent off, and some hundred times as fast once a cell is known. What it returns depends on
  /// its arguments only. Does not allocate.
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
  std::vector<Cell> cells_;  // a hash table in which the latest takes the place of another
};

}  // namespace wiimote_tracker::geometry

#endif  // WIIMOTE_TRACKER_TRIANGULATION_GEOMETRY_CALIBRATION_UNCERTAINTY_H
