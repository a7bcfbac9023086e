#pragma once

#include "wiimote_tracker_triangulation/geometry/linear_algebra.h"

#include <cmath>

namespace wiimote_tracker::geometry::test {

/// Errors of estimated positions, and how they fit their covariances.
struct Accuracy {
  double squares = 0.0;    ///< Of the errors [m^2], summed.
  double distances = 0.0;  ///< Squared, of Mahalanobis, summed.
  int inside = 0;          ///< Within the ellipsoid of 95 %.
  int count = 0;

  void add(const Eigen::Vector3d& error, const Eigen::Matrix3d& covariance) {
    constexpr double kLargest = 7.814727903;  // 95 % of chi square with three degrees of freedom
    const double distance = squaredMahalanobis(error, covariance);
    squares += error.squaredNorm();
    distances += distance;
    inside += distance < kLargest;
    ++count;
  }

  double rms() const { return std::sqrt(squares / count); }  ///< [m]
  double nees() const { return distances / count; }          ///< 3 where the covariance is right.
  double shareInside() const { return static_cast<double>(inside) / count; }
};

}  // namespace wiimote_tracker::geometry::test
