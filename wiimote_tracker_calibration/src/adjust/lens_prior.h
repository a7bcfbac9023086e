#pragma once

#include "adjust/pixel.h"

#include <wiimote_tracker_triangulation/geometry/camera.h>

#include <Eigen/Core>

#include <cmath>
#include <limits>

namespace wiimote_tracker::adjust {

/// Prior of a lens, whitened. Block: lens (CameraBlocks).
struct LensPrior {
  geometry::Intrinsics mean;
  double focal;            ///< Standard deviation of the focal length, relative [1].
  double aspect;           ///< Of fx / fy, relative [1].
  double principal_point;  ///< Per axis [px].
  double k1;               ///< [1]

  ceres::CostFunction* cost() const { return costOf<kLensSize, kLensSize>(*this); }

  /// Distance of a lens from the mean [standard deviations]; infinite without positive focal
  /// length.
  double deviation(const geometry::Intrinsics& in) const {
    const double lens[kLensSize] = {in.fx, in.fy, in.cx, in.cy, in.distortion[0]};
    Eigen::Matrix<double, kLensSize, 1> residual;
    return (*this)(lens, residual.data()) ? residual.norm()
                                          : std::numeric_limits<double>::infinity();
  }

  /// False where a focal length is not positive.
  template <typename T>
  bool operator()(const T* lens, T* residual) const {
    using std::log;
    if (!(lens[0] > T(0.0)) || !(lens[1] > T(0.0)))
      return false;
    const T log_x = log(lens[0] / mean.fx);
    const T log_y = log(lens[1] / mean.fy);
    residual[0] = 0.5 * (log_x + log_y) / focal;
    residual[1] = (log_x - log_y) / aspect;
    residual[2] = (lens[2] - mean.cx) / principal_point;
    residual[3] = (lens[3] - mean.cy) / principal_point;
    residual[4] = (lens[4] - mean.distortion[0]) / k1;
    return true;
  }
};

/// The same where the principal points of several cameras share an offset from the mean. Blocks:
/// lens (CameraBlocks), the shared offset (2) [px], which has a prior of its own.
struct SharedLensPrior {
  LensPrior own;  ///< Around the shifted mean.

  ceres::CostFunction* cost() const { return costOf<kLensSize, kLensSize, 2>(*this); }

  template <typename T>
  bool operator()(const T* lens, const T* shared, T* residual) const {
    const T shifted[kLensSize] = {lens[0], lens[1], lens[2] - shared[0], lens[3] - shared[1],
                                  lens[4]};
    return own(shifted, residual);
  }
};

}  // namespace wiimote_tracker::adjust
