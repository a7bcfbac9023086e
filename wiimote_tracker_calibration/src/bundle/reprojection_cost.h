#ifndef WIIMOTE_TRACKER_CALIBRATION_SRC_BUNDLE_REPROJECTION_COST_H
#define WIIMOTE_TRACKER_CALIBRATION_SRC_BUNDLE_REPROJECTION_COST_H

#include "wiimote_tracker_calibration/bundle/solve.h"

#include <Eigen/Core>

#include <ceres/autodiff_cost_function.h>
#include <ceres/rotation.h>

#include <cmath>
#include <cstddef>

namespace wiimote_tracker::bundle {

/// fx, fy, cx, cy [px], k1, k2, p1, p2, k3 [1].
constexpr int kIntrinsicsSize = 9;

/// Projected minus observed pixel [px] of a point seen through a lens of either model.
/// Blocks: intrinsics (kIntrinsicsSize), camera_from_world as angle-axis (3) [rad], optical centre
/// (3) and point (3), both in the world [m].
class ReprojectionCost {
 public:
  static ceres::CostFunction* create(const Eigen::Vector2d& pixel,
                                     geometry::DistortionModel model) {
    return new ceres::AutoDiffCostFunction<ReprojectionCost, 2, kIntrinsicsSize, 3, 3, 3>(
        new ReprojectionCost(pixel, model));
  }

  ReprojectionCost(const Eigen::Vector2d& pixel, geometry::DistortionModel model)
      : pixel_(pixel), model_(model) {}

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
    T distorted[2];
    if (model_ == geometry::DistortionModel::kEquidistant)
      distortEquidistant(x, y, intrinsics + 4, distorted);
    else
      distortPlumbBob(x, y, intrinsics + 4, distorted);
    residual[0] = intrinsics[0] * distorted[0] + intrinsics[2] - T(pixel_.x());
    residual[1] = intrinsics[1] * distorted[1] + intrinsics[3] - T(pixel_.y());
    return true;
  }

 private:
  /// Brown 1966; k: k1, k2, p1, p2, k3.
  template <typename T>
  static void distortPlumbBob(const T& x, const T& y, const T* k, T* distorted) {
    const T r2 = x * x + y * y;
    const T radial = T(1.0) + r2 * (k[0] + r2 * (k[1] + r2 * k[4]));
    const T two_xy = T(2.0) * x * y;
    distorted[0] = x * radial + k[2] * two_xy + k[3] * (r2 + T(2.0) * x * x);
    distorted[1] = y * radial + k[2] * (r2 + T(2.0) * y * y) + k[3] * two_xy;
  }

  /// Kannala and Brandt 2006; k: k1 to k4.
  template <typename T>
  static void distortEquidistant(const T& x, const T& y, const T* k, T* distorted) {
    using std::atan;
    using std::sqrt;
    const T r2 = x * x + y * y;
    T scale(1.0);
    if (r2 > T(1e-16)) {  // the square root has no derivative at 0
      const T r = sqrt(r2);
      const T angle = atan(r);
      const T a2 = angle * angle;
      scale = angle / r * (T(1.0) + a2 * (k[0] + a2 * (k[1] + a2 * (k[2] + a2 * k[3]))));
    }
    distorted[0] = x * scale;
    distorted[1] = y * scale;
  }

  Eigen::Vector2d pixel_;
  geometry::DistortionModel model_;
};

/// What is known of a lens without looking, in standard deviations times `weight`: that of a pixel,
/// to go with ReprojectionCost. Block: intrinsics.
class LensPriorCost {
 public:
  static ceres::CostFunction* create(const geometry::Intrinsics& start,
                                     const LensPrior& prior,
                                     double weight) {
    return new ceres::AutoDiffCostFunction<LensPriorCost, kIntrinsicsSize, kIntrinsicsSize>(
        new LensPriorCost(start, prior, weight));
  }

  LensPriorCost(const geometry::Intrinsics& start, const LensPrior& prior, double weight)
      : start_(start), prior_(prior), weight_(weight) {}

  /// False where a focal length is not positive.
  template <typename T>
  bool operator()(const T* intrinsics, T* residual) const {
    using std::log;
    const T& fx = intrinsics[0];
    const T& fy = intrinsics[1];
    if (!(fx > T(0.0)) || !(fy > T(0.0)))
      return false;
    const double center_stddev = prior_.principal_point * start_.width;
    const double about = prior_.focal_about > 0.0 ? prior_.focal_about * start_.width
                                                  : std::sqrt(start_.fx * start_.fy);
    residual[0] = log(fx * fy / (about * about)) / T(2.0 * prior_.focal_length);
    residual[1] = log(fx / fy) / T(prior_.aspect);
    residual[2] = (intrinsics[2] - T(0.5 * (start_.width - 1))) / T(center_stddev);
    residual[3] = (intrinsics[3] - T(0.5 * (start_.height - 1))) / T(center_stddev);
    for (std::size_t i = 0; i < prior_.distortion.size(); ++i)
      residual[4 + i] = intrinsics[4 + i] / T(prior_.distortion[i]);
    for (int i = 0; i < kIntrinsicsSize; ++i)
      residual[i] *= T(weight_);
    return true;
  }

 private:
  geometry::Intrinsics start_;
  LensPrior prior_;
  double weight_;
};

}  // namespace wiimote_tracker::bundle

#endif  // WIIMOTE_TRACKER_CALIBRATION_SRC_BUNDLE_REPROJECTION_COST_H
