#include "camera_fit.h"

#include "wiimote_tracker_triangulation/geometry/point_sensitivity.h"

#include <Eigen/LU>

namespace wiimote_tracker::tracking {

bool isByCalibration(const geometry::Rig& rig,
                     const Eigen::Vector3d& led,
                     std::size_t camera,
                     const CameraList& others,
                     const Eigen::Vector2d& residual,
                     const Eigen::Matrix2d& covariance) {
  constexpr double kSquaredDistance = 9.0;  // three standard deviations
  const auto of_calibration =
      geometry::disagreementCovariance(rig, led, camera, others.data(), others.size());
  if (!of_calibration)
    return false;
  const Eigen::Matrix2d of_both = covariance + *of_calibration;
  return residual.dot(of_both.inverse() * residual) <= kSquaredDistance;
}

}  // namespace wiimote_tracker::tracking
