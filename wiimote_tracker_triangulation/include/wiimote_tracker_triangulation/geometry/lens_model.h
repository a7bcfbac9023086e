#pragma once

#include "wiimote_tracker_triangulation/geometry/camera.h"

#include <Eigen/Core>

#include <cmath>

// The lens models, for any scalar: double, or a dual number such as ceres::Jet. They map a point on
// the image plane of depth 1 from its undistorted to its distorted place, linearly in its
// coefficients: geometry/camera_parameters.cpp takes the derivatives by differences.

namespace wiimote_tracker::geometry {

/// Brown 1966; k: k1, k2, p1, p2, k3.
template <typename T>
Eigen::Matrix<T, 2, 1> distortPlumbBob(const T* k, const Eigen::Matrix<T, 2, 1>& n) {
  const T& k1 = k[0];
  const T& k2 = k[1];
  const T& p1 = k[2];
  const T& p2 = k[3];
  const T& k3 = k[4];
  const T& x = n[0];
  const T& y = n[1];
  const T r2 = x * x + y * y;
  const T radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
  return {x * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x),
          y * radial + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y};
}

/// Distance from the optical axis in the image of an equidistant lens, over the angle from that
/// axis [rad]; k: k1, k2, k3, k4.
template <typename T>
T equidistantRadius(const T* k, const T& angle) {
  const T s = angle * angle;
  return angle * (1.0 + s * (k[0] + s * (k[1] + s * (k[2] + s * k[3]))));
}

/// Kannala and Brandt 2006; k: k1, k2, k3, k4.
template <typename T>
Eigen::Matrix<T, 2, 1> distortEquidistant(const T* k, const Eigen::Matrix<T, 2, 1>& n) {
  using std::atan;
  using std::sqrt;
  const T r2 = n[0] * n[0] + n[1] * n[1];
  if (!(r2 > T(1e-16))) {  // the first terms: on the axis the root has no derivative
    const T scale = 1.0 + (k[0] - 1.0 / 3.0) * r2;
    return {scale * n[0], scale * n[1]};
  }
  const T r = sqrt(r2);
  const T scale = equidistantRadius(k, T(atan(r))) / r;
  return {scale * n[0], scale * n[1]};
}

/// `k`: the model's coefficients, as in Intrinsics::distortion.
template <typename T>
Eigen::Matrix<T, 2, 1> distort(DistortionModel model, const T* k, const Eigen::Matrix<T, 2, 1>& n) {
  switch (model) {
    case DistortionModel::kPlumbBob:
      break;
    case DistortionModel::kEquidistant:
      return distortEquidistant(k, n);
  }
  return distortPlumbBob(k, n);
}

/// Pixel of a point on the normalised image plane; `lens`: fx, fy, cx, cy [px], then the
/// coefficients, which is the order of a rig's covariance.
template <typename T>
Eigen::Matrix<T, 2, 1> pixelFromNormalized(DistortionModel model,
                                           const T* lens,
                                           const Eigen::Matrix<T, 2, 1>& n) {
  const Eigen::Matrix<T, 2, 1> distorted = distort(model, lens + 4, n);
  return {lens[0] * distorted[0] + lens[2], lens[1] * distorted[1] + lens[3]};
}

}  // namespace wiimote_tracker::geometry
