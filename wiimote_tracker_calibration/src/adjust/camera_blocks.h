#pragma once

#include <wiimote_tracker_triangulation/geometry/camera.h>
#include <wiimote_tracker_triangulation/geometry/camera_parameters.h>

#include <ceres/loss_function.h>
#include <ceres/problem.h>

#include <Eigen/Core>

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace wiimote_tracker::adjust {

// Sizes of a camera's parameter blocks.
constexpr int kRotationSize = 3;  ///< w [rad]: R = exp([w]x) R_start, about the world's axes.
constexpr int kPositionSize = 3;  ///< Optical centre in the world [m].
constexpr int kLensSize = 5;  ///< fx, fy, cx, cy [px], the lens model's first coefficient k1 [1].
constexpr int kHigherDistortionSize = 4;  ///< The coefficients after k1 [1].
constexpr int kTimeOffsetSize = 1;        ///< Exposure time minus stamp [s].

/// One camera as parameter blocks of Ceres, side by side in the order of a rig's covariance
/// (geometry/camera_parameters.h). A solver holds the blocks that it does not estimate with
/// ceres::Problem::SetParameterBlockConstant(): the higher distortion but in self_calibrate.
struct CameraBlocks {
  explicit CameraBlocks(const geometry::Camera& camera, double time_offset = 0.0);

  /// The camera that these values describe; name, identity and image size are those of `other`.
  geometry::Camera cameraLike(const geometry::Camera& other) const;

  double* rotation() { return values.data(); }
  double* position() { return rotation() + kRotationSize; }
  double* lens() { return position() + kPositionSize; }
  double* higherDistortion() { return lens() + kLensSize; }
  double* timeOffset() { return &values.back(); }

  std::vector<double*> all() {
    return {rotation(), position(), lens(), higherDistortion(), timeOffset()};
  }
  static constexpr std::array<std::int32_t, 5> kSizes = {kRotationSize, kPositionSize, kLensSize,
                                                         kHigherDistortionSize, kTimeOffsetSize};

  /// Adds a residual of the first four blocks and of some others to a problem.
  /// @param loss null: none. The problem owns it.
  template <typename... Others>
  ceres::ResidualBlockId addTo(ceres::Problem* problem,
                               ceres::CostFunction* cost,
                               ceres::LossFunction* loss,
                               Others*... others) {
    return problem->AddResidualBlock(cost, loss, rotation(), position(), lens(), higherDistortion(),
                                     others...);
  }

  Eigen::Matrix3d world_from_start;            ///< Where the rotation starts from; not estimated.
  geometry::DistortionModel distortion_model;  ///< Not estimated.
  std::array<double, geometry::kParameters> values;
};

/// A new Cauchy loss for one residual; null if the scale is infinite.
inline ceres::LossFunction* lossOf(double scale) {
  return std::isfinite(scale) ? new ceres::CauchyLoss(scale) : nullptr;
}

/// Those of several cameras, one after the other.
inline std::vector<double*> blocksOf(std::vector<CameraBlocks>* cameras) {
  std::vector<double*> blocks;
  for (CameraBlocks& camera : *cameras) {
    for (double* const block : camera.all())
      blocks.push_back(block);
  }
  return blocks;
}

}  // namespace wiimote_tracker::adjust
