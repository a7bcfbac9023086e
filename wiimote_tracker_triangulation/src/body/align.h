#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cstddef>

namespace wiimote_tracker::body {

struct PointPair {
  Eigen::Vector3d in_body;   ///< [m]
  Eigen::Vector3d in_world;  ///< [m]
  double weight = 1.0;       ///< [> 0]
};

struct Alignment {
  Eigen::Isometry3d world_from_body;
  double cost;  ///< Sum of weight times squared distance.
};

/// The rigid transform that fits pairs of points best (weighted least squares by an SVD; Arun et
/// al. 1987, with the sign of Umeyama 1991), never a reflection. Fewer than three pairs, or pairs
/// on a line, leave a rotation free; then one of the best transforms is returned. Never allocates.
Alignment align(const PointPair* pairs, std::size_t count);

}  // namespace wiimote_tracker::body
