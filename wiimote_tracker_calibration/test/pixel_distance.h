#pragma once

#include <wiimote_tracker_triangulation/geometry/camera.h>

#include <Eigen/Core>

#include <cmath>

namespace wiimote_tracker {

/// RMS distance of two cameras' pixels of points in the volume [px].
inline double pixelDistance(const geometry::Camera& a, const geometry::Camera& b) {
  double sum = 0.0;
  int count = 0;
  for (int i = 0; i < 27; ++i) {
    const Eigen::Vector3d point = Eigen::Vector3d::Constant(0.5) +
                                  0.75 * Eigen::Vector3i(i % 3, i / 3 % 3, i / 9).cast<double>();
    const auto pixel_a = a.project(point);
    const auto pixel_b = b.project(point);
    if (!pixel_a || !pixel_b)
      continue;
    sum += (*pixel_a - *pixel_b).squaredNorm();
    ++count;
  }
  return std::sqrt(sum / count);
}

}  // namespace wiimote_tracker
