#ifndef WIIMOTE_TRACKER_CALIBRATION_SRC_BUNDLE_REPROJECTION_COST_H
#define WIIMOTE_TRACKER_CALIBRATION_SRC_BUNDLE_REPROJECTION_COST_H

#include <Eigen/Core>

#include <ceres/autodiff_cost_function.h>
#include <ceres/rotation.h>

namespace wiimote_tracker::bundle {

/// fx, fy, cx, cy [px], k1, k2, p1, p2, k3 [1].
constexpr int kIntrinsicsSize = 9;

/// Projected minus observed pixel [px] of a point seen through a plumb_bob lens (Brown 1966).
/// Blocks: intrinsics (kIntrinsicsSize), camera_from_world as angle-axis (3) [rad], optical centre
/// (3) and point (3), both in the world [m].
class ReprojectionCost {
 public:
  static ceres::CostFunction* create(const Eigen::Vector2d& pixel) {
    return new ceres::AutoDiffCostFunction<ReprojectionCost, 2, kIntrinsicsSize, 3, 3, 3>(
        new ReprojectionCost(pixel));
  }

  explicit ReprojectionCost(const Eigen::Vector2d& pixel) : pixel_(pixel) {}

  /// False, which makes the solver try a smaller step, when the point is not in front.
  template <typename T>
  bool operator()(const T* intrinsics,
                  const T* rotation,
                  const T* position,
                  const T* point,
                  T* residual) const {
    const T in_world[3] = {point[0] - position[0], point[1] - position[1], point[2] - position[2]};
    T in_camera[3];
    ceres::AngleAxisRotatePoint(rotation, in_world, in_camera);
    if (!(in_camera[2] > T(0.0)))
      return false;
    const T x = in_camera[0] / in_camera[2];
    const T y = in_camera[1] / in_camera[2];
    const T r2 = x * x + y * y;
    const T* k = intrinsics + 4;
    const T radial = T(1.0) + r2 * (k[0] + r2 * (k[1] + r2 * k[4]));
    const T two_xy = T(2.0) * x * y;
    const T distorted_x = x * radial + k[2] * two_xy + k[3] * (r2 + T(2.0) * x * x);
    const T distorted_y = y * radial + k[2] * (r2 + T(2.0) * y * y) + k[3] * two_xy;
    residual[0] = intrinsics[0] * distorted_x + intrinsics[2] - T(pixel_.x());
    residual[1] = intrinsics[1] * distorted_y + intrinsics[3] - T(pixel_.y());
    return true;
  }

 private:
  Eigen::Vector2d pixel_;
};

}  // namespace wiimote_tracker::bundle

#endif  // WIIMOTE_TRACKER_CALIBRATION_SRC_BUNDLE_REPROJECTION_COST_H
