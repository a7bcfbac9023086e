#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace wiimote_tracker::geometry {

/// Rotation matrix of a quaternion, which need not be of unit length.
Eigen::Matrix3d matrixFromQuaternion(const Eigen::Quaterniond& quaternion);

/// The quaternion that files and messages store for a rotation matrix. It survives any number of
/// round trips bit for bit: canonicalQuaternion(matrixFromQuaternion(q)) == q for every q that this
/// function returned. Unit length up to rounding, the first of w, x, y, z that is not 0 positive.
Eigen::Quaterniond canonicalQuaternion(const Eigen::Matrix3d& rotation);

}  // namespace wiimote_tracker::geometry
