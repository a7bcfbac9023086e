#ifndef WIIMOTE_TRACKER_CALIBRATION_SQUARE_RESIDUALS_H
#define WIIMOTE_TRACKER_CALIBRATION_SQUARE_RESIDUALS_H

#include "wiimote_tracker_calibration/square/rig_model.h"

#include <wiimote_tracker_triangulation/geometry/camera.h>

#include <ceres/rotation.h>

#include <Eigen/Core>

#include <array>
#include <cmath>

namespace wiimote_tracker::square {

/// Parameter blocks of the least-squares problem.
/// Pose: small rotation w about the world axes [rad], R = exp([w]x) R_start, then position [m].
constexpr int kPoseSize = 6;
/// Lens: fx, fy, cx, cy [px], k1. The other coefficients are held.
constexpr int kLensSize = 5;
/// Horizontal displacement of a corner from its place in the layout [m].
constexpr int kCornerSize = 2;

/// Rotates a world vector into the optical frame.
template <typename T>
void cameraFromWorld(const T* pose, const Eigen::Matrix3d& world_from_start, const T* in, T* out) {
  const T inverse[3] = {-pose[0], -pose[1], -pose[2]};
  T turned[3];
  ceres::AngleAxisRotatePoint(inverse, in, turned);
  for (int i = 0; i < 3; ++i)
    out[i] = turned[0] * world_from_start(0, i) + turned[1] * world_from_start(1, i) +
             turned[2] * world_from_start(2, i);
}

/// Reprojection error of one corner in one image, whitened.
struct PixelResidual {
  Eigen::Vector2d pixel;
  Eigen::Vector3d nominal_corner;
  Eigen::Matrix3d world_from_start;
  geometry::DistortionModel model;
  std::array<double, 5> distortion;
  double stddev;

  template <typename T>
  bool operator()(const T* pose, const T* lens, const T* offset, T* residual) const {
    const T from_center[3] = {nominal_corner.x() + offset[0] - pose[3],
                              nominal_corner.y() + offset[1] - pose[4],
                              nominal_corner.z() - pose[5]};
    T point[3];
    cameraFromWorld(pose, world_from_start, from_center, point);
    if (!(point[2] > T(1e-6)))
      return false;
    const T x = point[0] / point[2];
    const T y = point[1] / point[2];
    T distorted[2];
    if (model == geometry::DistortionModel::kEquidistant)
      distortEquidistant(x, y, lens[4], distorted);
    else
      distortPlumbBob(x, y, lens[4], distorted);
    residual[0] = (lens[0] * distorted[0] + lens[2] - pixel.x()) / stddev;
    residual[1] = (lens[1] * distorted[1] + lens[3] - pixel.y()) / stddev;
    return true;
  }

  template <typename T>
  void distortPlumbBob(const T& x, const T& y, const T& k1, T* out) const {
    const double k2 = distortion[1];
    const double p1 = distortion[2];
    const double p2 = distortion[3];
    const double k3 = distortion[4];
    const T r2 = x * x + y * y;
    const T radial = T(1.0) + r2 * (k1 + r2 * (k2 + r2 * k3));
    out[0] = x * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x);
    out[1] = y * radial + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y;
  }

  template <typename T>
  void distortEquidistant(const T& x, const T& y, const T& k1, T* out) const {
    using std::atan2;
    using std::sqrt;
    const T r2 = x * x + y * y;
    T radial =
        T(1.0) + (k1 - 1.0 / 3.0) * r2;  // the first terms: on the axis the root has no slope
    if (r2 > T(1e-12)) {
      const T r = sqrt(r2);
      const T angle = atan2(r, T(1.0));
      const T a2 = angle * angle;
      radial =
          angle / r *
          (T(1.0) + a2 * (k1 + a2 * (distortion[1] + a2 * (distortion[2] + a2 * distortion[3]))));
    }
    out[0] = x * radial;
    out[1] = y * radial;
  }
};

/// What is known of a lens beforehand, whitened.
struct LensPrior {
  geometry::Intrinsics start;
  Uncertainty uncertainty;

  template <typename T>
  bool operator()(const T* lens, T* residual) const {
    using std::log;
    if (!(lens[0] > T(0.0)) || !(lens[1] > T(0.0)))
      return false;
    const T log_x = log(lens[0] / start.fx);
    const T log_y = log(lens[1] / start.fy);
    residual[0] = 0.5 * (log_x + log_y) / uncertainty.focal;
    residual[1] = (log_x - log_y) / uncertainty.aspect;
    residual[2] = (lens[2] - start.cx) / uncertainty.principal_point;
    residual[3] = (lens[3] - start.cy) / uncertainty.principal_point;
    residual[4] = (lens[4] - start.distortion[0]) / uncertainty.k1;
    return true;
  }
};

/// Placement error of one corner, whitened.
struct CornerPrior {
  double stddev;

  template <typename T>
  bool operator()(const T* offset, T* residual) const {
    residual[0] = offset[0] / stddev;
    residual[1] = offset[1] / stddev;
    return true;
  }
};

/// Floor's up against the accelerometer's, whitened. The length of the difference of two unit
/// vectors grows with the angle up to 180 degrees, so that an upside-down pose costs most.
struct GravityResidual {
  Eigen::Vector3d up_in_camera;
  Eigen::Vector3d up_in_world;
  Eigen::Matrix3d world_from_start;
  double stddev;

  template <typename T>
  bool operator()(const T* pose, T* residual) const {
    const T up[3] = {T(up_in_world.x()), T(up_in_world.y()), T(up_in_world.z())};
    T turned[3];
    cameraFromWorld(pose, world_from_start, up, turned);
    for (int i = 0; i < 3; ++i)
      residual[i] = (turned[i] - up_in_camera[i]) / stddev;
    return true;
  }
};

}  // namespace wiimote_tracker::square

#endif  // WIIMOTE_TRACKER_CALIBRATION_SQUARE_RESIDUALS_H
