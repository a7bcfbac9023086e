#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_GEOMETRY_DISTORTION_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_GEOMETRY_DISTORTION_H

#include <Eigen/Core>

#include <array>
#include <optional>

// The lens models on the image plane of depth 1, between undistorted and distorted points. None of
// them allocates.

namespace wiimote_tracker::geometry {

using Coefficients = std::array<double, 5>;

/// k1, k2, p1, p2, k3.
namespace plumb_bob {

/// `jacobian`: d result / d n, when it is not null.
Eigen::Vector2d distort(const Coefficients& k, const Eigen::Vector2d& n, Eigen::Matrix2d* jacobian);

/// Nothing where no point before the fold has this image. The target must be finite.
std::optional<Eigen::Vector2d> undistort(const Coefficients& k, const Eigen::Vector2d& target);

/// distort(), or nothing beyond the fold. `jacobian` must not be null.
std::optional<Eigen::Vector2d> distortBeforeFold(const Coefficients& k,
                                                 const Eigen::Vector2d& n,
                                                 Eigen::Matrix2d* jacobian);

}  // namespace plumb_bob

/// k1, k2, k3, k4, and a zero. With a, the angle from the axis, the radius becomes
/// a (1 + k1 a^2 + k2 a^4 + k3 a^6 + k4 a^8).
namespace equidistant {

Eigen::Vector2d distort(const Coefficients& k, const Eigen::Vector2d& n, Eigen::Matrix2d* jacobian);

std::optional<Eigen::Vector2d> undistort(const Coefficients& k, const Eigen::Vector2d& target);

/// Nothing beyond 1.55 rad from the axis either.
std::optional<Eigen::Vector2d> distortBeforeFold(const Coefficients& k,
                                                 const Eigen::Vector2d& n,
                                                 Eigen::Matrix2d* jacobian);

}  // namespace equidistant

}  // namespace wiimote_tracker::geometry

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_GEOMETRY_DISTORTION_H
