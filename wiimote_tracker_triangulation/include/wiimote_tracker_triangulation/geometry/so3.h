#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cmath>

/// Rotations and rotation vectors, whose direction is the axis and whose length is the angle [rad].
namespace wiimote_tracker::geometry::so3 {

/// The matrix [v]x of the cross product: skew(v) * w = v x w.
inline Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
  Eigen::Matrix3d matrix;
  matrix << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return matrix;
}

/// The rotation exp([v]x) of a rotation vector. It multiplies matrices and quaternions.
inline Eigen::AngleAxisd exp(const Eigen::Vector3d& v) {
  const double angle = v.norm();
  return angle == 0.0 ? Eigen::AngleAxisd::Identity() : Eigen::AngleAxisd(angle, v / angle);
}

/// The rotation vector of a rotation: the inverse of exp(), with an angle of at most pi.
inline Eigen::Vector3d log(const Eigen::Matrix3d& rotation) {
  const Eigen::AngleAxisd turn(rotation);
  return turn.angle() * turn.axis();
}

/// The angle by which two attitudes differ [rad, 0..pi].
inline double angleBetween(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
  return Eigen::AngleAxisd(a.transpose() * b).angle();
}

/// The smallest rotation that turns the direction of `from` to that of `to`, both not zero.
/// Opposite directions have many; it is one of them.
inline Eigen::AngleAxisd between(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const Eigen::Vector3d across = from.cross(to);
  const double length = across.norm();
  return Eigen::AngleAxisd(std::atan2(length, from.dot(to)),
                           length > 0.0 ? across / length : from.unitOrthogonal());
}

}  // namespace wiimote_tracker::geometry::so3
