#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_ASSOCIATION_EPIPOLAR_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_ASSOCIATION_EPIPOLAR_H

#include "wiimote_tracker_triangulation/geometry/sight.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace wiimote_tracker::association {

/// One of the two spots of an epipolar constraint.
struct EpipolarSpot {
  EpipolarSpot(const geometry::Sight& sight, double pixel_stddev)
      : direction(sight.direction),
        direction_by_pixel(sight.directionByPixel() * pixel_stddev),
        spread(direction_by_pixel.squaredNorm()) {}

  Eigen::Vector3d direction;
  Eigen::Matrix<double, 3, 2> direction_by_pixel;  ///< For one standard deviation.
  double spread;                                   ///< Upper bound of its squared length.
};

/// Squared distance of two spots from the constraint that their rays meet, over the variance of a
/// pixel: f^2 / |d f / d (pixel a, pixel b)|^2 with f = baseline . (direction a x direction b)
/// (Sampson's distance). normal_a = baseline x direction a, normal_b likewise; f = normal_a .
/// direction b.
inline double epipolarChiSquared(const EpipolarSpot& a,
                                 const Eigen::Vector3d& normal_a,
                                 const EpipolarSpot& b,
                                 const Eigen::Vector3d& normal_b,
                                 double f) {
  const double by_a = (normal_b.transpose() * a.direction_by_pixel).squaredNorm();
  const double by_b = (normal_a.transpose() * b.direction_by_pixel).squaredNorm();
  return f * f / (by_a + by_b);
}

}  // namespace wiimote_tracker::association

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_ASSOCIATION_EPIPOLAR_H
