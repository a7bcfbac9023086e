#pragma once

#include <Eigen/Core>

#include <cmath>
#include <random>

namespace wiimote_tracker::remap {

using Random = std::mt19937_64;

/// Normal noise of each coordinate.
inline Eigen::Vector3d noise(Random& random, double stddev) {
  std::normal_distribution<double> normal(0.0, stddev);
  const double x = normal(random);
  const double y = normal(random);
  return Eigen::Vector3d(x, y, normal(random));
}

/// Where a smooth deformation of the volume puts a point [m], which is none of the parametric
/// models.
inline Eigen::Vector3d wavy(const Eigen::Vector3d& p) {
  return p + 0.05 * Eigen::Vector3d(std::sin(1.2 * p.y()), std::cos(1.2 * p.z()),
                                    std::sin(1.2 * p.x() + 1.0));
}

}  // namespace wiimote_tracker::remap
