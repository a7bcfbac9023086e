#pragma once

#include "wiimote_tracker_calibration/intrinsics/solve_intrinsics.h"

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include <cmath>
#include <cstddef>
#include <vector>

namespace wiimote_tracker::intrinsics {

constexpr int kPoseParameters = 6;

/// The views in OpenCV's types.
struct Points {
  explicit Points(const Samples& samples);

  std::vector<std::vector<cv::Point3f>> board;
  std::vector<std::vector<cv::Point2f>> image;
  cv::Size image_size;
  std::size_t count = 0;
};

/// A lens and the board's poses in OpenCV's types.
struct Fit {
  LensModel model = LensModel::kNoDistortion;
  cv::Mat camera_matrix;  // 3 x 3
  cv::Mat distortion;     // 5 coefficients, or the 4 of an equidistant lens
  std::vector<cv::Mat> rotations;
  std::vector<cv::Mat> translations;
  double error = HUGE_VAL;  // reprojection error [px]; not finite: could not be fitted

  bool ok() const { return std::isfinite(error); }
};

/// Fits a lens without distortion, or an equidistant one without coefficients, from this focal
/// length and a much shorter one. @throws Error: nothing fits.
Fit firstFit(const Points& points, bool equidistant, double focal_length);

/// The model with the least reprojection error, from a fit of the same kind. @param roughly whether
/// the result only starts another fit.
Fit refined(const Fit& start, LensModel model, const Points& points, bool roughly = false);

geometry::Intrinsics intrinsicsOf(const Fit& fit, const Points& points);

/// Parameters that a model estimates, in the order fx, fy, cx, cy, then the coefficients.
int parameterCount(LensModel model);

/// Derivatives of one view's pixels: u, v, u, v, ...
struct ViewDerivative {
  Eigen::Matrix<double, Eigen::Dynamic, kPoseParameters> pose;  // of the board
  Eigen::MatrixXd lens;                                         // one column per parameter
};
ViewDerivative differentiate(const Fit& fit, const Points& points, std::size_t view);

}  // namespace wiimote_tracker::intrinsics
