#include "wiimote_tracker_calibration/square/expected_error.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace wiimote_tracker::square {

namespace {

// Parameters of one camera in the joint covariance (RigCalibration.msg), and their steps of
// numerical differentiation; the time offset does not move a still point.
constexpr Eigen::Index kParameters = 16;
constexpr Eigen::Index kPixelParameters = 15;
constexpr double kStep[kPixelParameters] = {1e-6, 1e-6, 1e-6, 1e-6, 1e-6, 1e-6, 1e-3, 1e-3,
                                            1e-3, 1e-3, 1e-6, 1e-6, 1e-6, 1e-6, 1e-6};

geometry::Camera changed(geometry::Camera camera, Eigen::Index parameter, double step) {
  geometry::Intrinsics& lens = camera.intrinsics;
  if (parameter < 3)
    camera.world_from_camera.linear() = Eigen::AngleAxisd(step, Eigen::Vector3d::Unit(parameter)) *
                                        camera.world_from_camera.linear();
  else if (parameter < 6)
    camera.world_from_camera.translation()[parameter - 3] += step;
  else if (parameter < 10)
    *std::array<double*, 4>{&lens.fx, &lens.fy, &lens.cx,
                            &lens.cy}[static_cast<std::size_t>(parameter - 6)] += step;
  else
    lens.distortion[static_cast<std::size_t>(parameter - 10)] += step;
  return camera;
}

/// d pixel / d parameters of the camera, and d pixel / d point. Nothing behind the camera.
struct Derivatives {
  Eigen::Matrix<double, 2, kParameters> parameters;
  Eigen::Matrix<double, 2, 3> point;
};

std::optional<Derivatives> differentiate(const geometry::Camera& camera,
                                         const Eigen::Vector3d& point) {
  Derivatives result;
  result.parameters.setZero();
  for (Eigen::Index k = 0; k < kPixelParameters; ++k) {
    const auto plus = changed(camera, k, kStep[k]).project(point);
    const auto minus = changed(camera, k, -kStep[k]).project(point);
    if (!plus || !minus)
      return std::nullopt;
    result.parameters.col(k) = (*plus - *minus) / (2.0 * kStep[k]);
  }
  // Moving the point is moving the camera the other way.
  result.point = -result.parameters.middleCols<3>(3);
  return result;
}

}  // namespace

double expectedError(const geometry::Rig& rig, const std::vector<Eigen::Vector3d>& points) {
  const auto cameras = static_cast<Eigen::Index>(rig.cameras.size());
  if (rig.covariance.rows() != kParameters * cameras || points.empty())
    return std::numeric_limits<double>::quiet_NaN();
  double sum = 0.0;
  int count = 0;
  for (const Eigen::Vector3d& point : points) {
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    Eigen::MatrixXd right = Eigen::MatrixXd::Zero(3, kParameters * cameras);
    int views = 0;
    for (Eigen::Index i = 0; i < cameras; ++i) {
      const geometry::Camera& camera = rig.cameras[static_cast<std::size_t>(i)].camera;
      const auto derivatives = camera.sees(point) ? differentiate(camera, point) : std::nullopt;
      if (!derivatives)
        continue;
      ++views;
      information += derivatives->point.transpose() * derivatives->point;
      right.middleCols(kParameters * i, kParameters) =
          derivatives->point.transpose() * derivatives->parameters;
    }
    if (views < 2)
      continue;
    ++count;
    const Eigen::MatrixXd point_from_parameters = information.inverse() * right;
    sum += (point_from_parameters * rig.covariance * point_from_parameters.transpose()).trace();
  }
  // Two views from one place see no depth: infinite information or none.
  const double mean = sum / count;
  return count > 0 && std::isfinite(mean) ? std::sqrt(mean)
                                          : std::numeric_limits<double>::quiet_NaN();
}

std::vector<Eigen::Vector3d> boxOver(const std::array<Eigen::Vector3d, 4>& corners, bool z_up) {
  const double height =
      std::min((corners[1] - corners[0]).norm(), (corners[2] - corners[1]).norm());
  const Eigen::Vector3d up(0.0, 0.0, z_up ? height : -height);
  std::vector<Eigen::Vector3d> points;
  for (const Eigen::Vector3d& corner : corners) {
    points.push_back(corner);
    points.push_back(corner + up);
  }
  points.push_back(0.5 * (corners[0] + corners[2] + up));
  return points;
}

}  // namespace wiimote_tracker::square
