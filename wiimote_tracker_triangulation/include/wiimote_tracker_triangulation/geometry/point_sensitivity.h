#pragma once

#include "wiimote_tracker_triangulation/geometry/camera_parameters.h"
#include "wiimote_tracker_triangulation/geometry/rig.h"

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <vector>

namespace wiimote_tracker::geometry {

/// d point / d parameters of one camera.
using PointJacobian = Eigen::Matrix<double, 3, kParameters>;

/// How a point that is triangulated by maximum likelihood from some cameras of a rig moves with the
/// rig's parameters, to first order: D_i = -(sum_j P_j^T P_j)^-1 P_i^T A_i, with the derivatives P
/// of a camera's pixel by the point and A by the camera's parameters (rayProjection()). The errors
/// of a calibration with covariance C give the point the covariance D C D^T.
/// @param velocity of the point [m/s]: time offsets shift what moves.
/// @param by_camera receives the `count` blocks D_i, in the order of `cameras`.
/// @returns false when the cameras do not determine the point: fewer than two, one without a pixel
/// of it, all at one place or in one line with it. Does not allocate.
bool pointSensitivity(const Rig& rig,
                      const Eigen::Vector3d& point,
                      const std::size_t* cameras,
                      std::size_t count,
                      PointJacobian* by_camera,
                      const Eigen::Vector3d& velocity = Eigen::Vector3d::Zero());

/// Of the cameras in disagreementCovariance().
constexpr std::size_t kMaximumOthers = 16;

/// How far a camera's spot of a still point may be from where it should be by the other cameras,
/// due to errors of the calibration: its covariance [px^2]. Errors that all cameras share cancel.
/// Nothing where the others do not determine the point, the camera has no pixel of it, or the rig
/// no covariance. Does not allocate.
/// @param others of the rig, without `camera`; at most kMaximumOthers count.
std::optional<Eigen::Matrix2d> disagreementCovariance(const Rig& rig,
                                                      const Eigen::Vector3d& point,
                                                      std::size_t camera,
                                                      const std::size_t* others,
                                                      std::size_t count);

/// pointSensitivity() as one matrix of 3 rows and a column for each parameter of the rig, 0 for
/// those of other cameras. Nothing where pointSensitivity() is false.
std::optional<Eigen::MatrixXd> pointByParameters(
    const Rig& rig,
    const Eigen::Vector3d& point,
    const std::vector<std::size_t>& cameras,
    const Eigen::Vector3d& velocity = Eigen::Vector3d::Zero());

/// The cameras of a rig that see a point (Camera::sees, of Rig::rayCamera()), ascending.
std::vector<std::size_t> camerasSeeing(const Rig& rig, const Eigen::Vector3d& point);

}  // namespace wiimote_tracker::geometry
