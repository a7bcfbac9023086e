#pragma once

#include "adjust/camera_blocks.h"

#include <wiimote_tracker_triangulation/geometry/lens_model.h>

#include <ceres/autodiff_cost_function.h>
#include <ceres/rotation.h>

#include <Eigen/Core>

#include <algorithm>

namespace wiimote_tracker::adjust {

/// Turns a world vector into the optical frame. @param rotation, world_from_start: CameraBlocks.
template <typename T>
void cameraFromWorld(const T* rotation,
                     const Eigen::Matrix3d& world_from_start,
                     const T* in_world,
                     T* in_camera) {
  const T inverse[3] = {-rotation[0], -rotation[1], -rotation[2]};
  T turned[3];
  ceres::AngleAxisRotatePoint(inverse, in_world, turned);
  for (int i = 0; i < 3; ++i)
    in_camera[i] = turned[0] * world_from_start(0, i) + turned[1] * world_from_start(1, i) +
                   turned[2] * world_from_start(2, i);
}

/// Cost function of a residual whose derivatives Ceres finds. @tparam kSizes of the residual and of
/// its blocks.
template <int... kSizes, typename Residual>
ceres::CostFunction* costOf(const Residual& residual) {
  return new ceres::AutoDiffCostFunction<Residual, kSizes...>(new Residual(residual));
}

/// Same of the error of a pixel. @tparam kOthers sizes of the blocks after those of CameraBlocks.
template <int... kOthers, typename Residual>
ceres::CostFunction* pixelCostOf(const Residual& residual) {
  return costOf<2, kRotationSize, kPositionSize, kLensSize, kHigherDistortionSize, kOthers...>(
      residual);
}

/// Projected minus observed pixel of a point, whitened.
/// Blocks: rotation, position, lens, distortion (CameraBlocks), point in the world (3) [m].
struct PixelError {
  Eigen::Vector2d pixel;      ///< Observed, distorted [px].
  Eigen::Matrix2d whitening;  ///< Inverse square root of its covariance [1/px].
  Eigen::Matrix3d world_from_start;
  geometry::DistortionModel model;

  PixelError(const CameraBlocks& camera,
             const Eigen::Vector2d& observed,
             const Eigen::Matrix2d& inverse_root)
      : pixel(observed),
        whitening(inverse_root),
        world_from_start(camera.world_from_start),
        model(camera.distortion_model) {}

  /// Both axes with the same standard deviation [px].
  PixelError(const CameraBlocks& camera, const Eigen::Vector2d& observed, double stddev)
      : PixelError(camera, observed, Eigen::Matrix2d::Identity() / stddev) {}

  ceres::CostFunction* cost() const { return pixelCostOf<3>(*this); }

  /// False when the point is not in front of the camera: the solver then tries a smaller step.
  template <typename T>
  bool operator()(const T* rotation,
                  const T* position,
                  const T* lens,
                  const T* distortion,
                  const T* point,
                  T* residual) const {
    const T from_center[3] = {point[0] - position[0], point[1] - position[1],
                              point[2] - position[2]};
    T in_camera[3];
    cameraFromWorld(rotation, world_from_start, from_center, in_camera);
    if (!(in_camera[2] > T(1e-6)))
      return false;
    T all[kLensSize + kHigherDistortionSize];
    std::copy(lens, lens + kLensSize, all);
    std::copy(distortion, distortion + kHigherDistortionSize, all + kLensSize);
    const Eigen::Matrix<T, 2, 1> normalized(in_camera[0] / in_camera[2],
                                            in_camera[1] / in_camera[2]);
    const Eigen::Matrix<T, 2, 1> error =
        geometry::pixelFromNormalized(model, all, normalized) - pixel.cast<T>();
    residual[0] = whitening(0, 0) * error[0] + whitening(0, 1) * error[1];
    residual[1] = whitening(1, 0) * error[0] + whitening(1, 1) * error[1];
    return true;
  }
};

}  // namespace wiimote_tracker::adjust
