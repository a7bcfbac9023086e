#pragma once

#include "wiimote_tracker_triangulation/geometry/camera.h"
#include "wiimote_tracker_triangulation/geometry/rig.h"

#include <Eigen/Core>

#include <cstddef>
#include <optional>

namespace wiimote_tracker::geometry {

/// Number of a camera's parameters in Rig::covariance, and the indices among them.
constexpr Eigen::Index kParameters = 16;
constexpr Eigen::Index kRotation = 0;    ///< w about the world axes [rad]: exp([w]x) R.
constexpr Eigen::Index kPosition = 3;    ///< World [m].
constexpr Eigen::Index kIntrinsics = 6;  ///< fx, fy, cx, cy [px], then the distortion.
constexpr Eigen::Index kDistortion = 10;
constexpr Eigen::Index kTimeOffset = 15;  ///< [s]

using ParameterJacobian = Eigen::Matrix<double, 2, kParameters>;

/// Index of a camera's first parameter.
inline Eigen::Index firstParameter(std::size_t camera) {
  return kParameters * static_cast<Eigen::Index>(camera);
}

/// Whether the rig has the covariance of its parameters.
inline bool hasCovariance(const Rig& rig) {
  return rig.covariance.size() > 0;
}

/// Pixel of a world point, and its derivatives.
struct Projection {
  Eigen::Vector2d pixel;
  Eigen::Matrix<double, 2, 3> by_point;  ///< [px/m]
  /// By the camera's parameters. The column of the time offset is 0: for a moving point it is
  /// by_point * velocity.
  ParameterJacobian by_parameters;
};

/// Nothing where the camera has no pixel of the point.
std::optional<Projection> projectionOf(const Camera& camera, const Eigen::Vector3d& point);

/// Same for the camera that a rig builds its rays with (Rig::rayCamera()). Derivatives by
/// parameters that the ray model replaces are 0.
std::optional<Projection> rayProjection(const Rig& rig,
                                        std::size_t camera,
                                        const Eigen::Vector3d& point);

/// Covariance of what changes by D_i with the parameters of the i-th of some cameras, due to errors
/// of the calibration: the sum of D_i C_ij D_j^T over all pairs of them. Does not allocate.
/// @param covariance of the rig. @param by_camera `count` blocks D_i, in the order of `cameras`.
template <int kRows>
Eigen::Matrix<double, kRows, kRows> propagatedErrors(
    const Eigen::MatrixXd& covariance,
    const Eigen::Matrix<double, kRows, kParameters>* by_camera,
    const std::size_t* cameras,
    std::size_t count) {
  using Square = Eigen::Matrix<double, kRows, kRows>;
  Square sum = Square::Zero();
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = 0; j < count; ++j) {
      const auto block = covariance.block<kParameters, kParameters>(firstParameter(cameras[i]),
                                                                    firstParameter(cameras[j]));
      const Eigen::Matrix<double, kRows, kParameters> left = by_camera[i].lazyProduct(block);
      sum += left.lazyProduct(by_camera[j].transpose());
    }
  }
  return 0.5 * (sum + sum.transpose());
}

}  // namespace wiimote_tracker::geometry
