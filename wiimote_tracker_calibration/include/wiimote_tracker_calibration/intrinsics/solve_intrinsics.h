#pragma once

#include "wiimote_tracker_calibration/intrinsics/board.h"

#include <wiimote_tracker_triangulation/geometry/camera.h>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker::intrinsics {

/// A lens and which of its coefficients are estimated; the others are 0.
enum class LensModel {
  kNoDistortion,
  kK1,  ///< plumb_bob, as the following two.
  kK1K2,
  kFull,         ///< k1, k2, p1, p2, k3.
  kEquidistant,  ///< A fisheye lens: k1, k2, k3, k4.
};

/// "no distortion", "k1", "k1, k2", "k1, k2, p1, p2, k3", "equidistant k1, k2, k3, k4".
std::string nameOf(LensModel model);

struct SolverOptions {
  /// Nothing: chosen from the data, see IntrinsicsSolution::model. kEquidistant must be requested:
  /// up to a field of view of some 100 degrees both kinds fit equally well.
  std::optional<LensModel> model;
  int minimum_views = 12;              ///< [>= 3]
  double start_focal_length = 1300.0;  ///< Fractions of it are tried too [px, > 0].
  double maximum_focal_stddev = 0.02;  ///< Of the focal length, else refused [1, > 0].
  double maximum_pixel_stddev = 2.0;   ///< Of the residuals, else refused [px, > 0].
  double maximum_aspect_error = 0.03;  ///< |fx / fy - 1|, else refused [1, > 0].
};

struct IntrinsicsSolution {
  geometry::Intrinsics intrinsics;

  /// Of fx, fy, cx, cy [px] and the coefficients in the order of geometry::Intrinsics [1]; zero for
  /// what was not estimated. Scaled by the residuals; includes the uncertainty of the board's
  /// poses.
  Eigen::Matrix<double, 9, 9> covariance = Eigen::Matrix<double, 9, 9>::Zero();

  /// The one requested, or of those that are one-to-one over the whole image the one with the least
  /// Bayesian information criterion (Schwarz 1978).
  LensModel model;
  double reprojection_error = 0.0;                   ///< sqrt(mean(du^2 + dv^2)) [px].
  double pixel_stddev = 0.0;                         ///< Of a pixel coordinate, as estimated [px].
  std::vector<Eigen::Isometry3d> camera_from_board;  ///< Of each view [m].
  std::string summary;                               ///< In words.
};

/// Focal lengths, principal point and distortion from views of the board (Zhang 2000), by OpenCV
/// (cv::calibrateCamera; cv::fisheye for kEquidistant). Takes some tenths of a second. The scale of
/// the board's spacings does not matter, their ratio does. Deterministic.
/// @throws Error: too few views; a view with too few LEDs, in one line, mirrored or not a
/// grid; the board never moved in the image or never tilted; views that do not fit the board;
/// spacings that make fx and fy differ; a focal length less certain than the options ask for; no
/// model that holds over the image.
IntrinsicsSolution solveIntrinsics(const Samples& samples, const SolverOptions& options);

}  // namespace wiimote_tracker::intrinsics
