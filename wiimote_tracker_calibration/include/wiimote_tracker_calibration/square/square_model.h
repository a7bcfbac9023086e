#pragma once

#include "wiimote_tracker_calibration/square/sightings.h"
#include "wiimote_tracker_calibration/square/square_layout.h"

#include <wiimote_tracker_triangulation/geometry/camera.h>

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace wiimote_tracker::square {

/// Standard deviations of the measurements (pixel, gravity) and of the priors (the rest), > 0
/// unless stated otherwise.
struct Uncertainty {
  double pixel = 0.2;            ///< Of a captured corner in an image, per axis [px].
  double placement = 0.005;      ///< Of the LED put on a corner, per horizontal axis [m].
  double focal = 0.03;           ///< Of the focal length, relative [1].
  double aspect = 0.005;         ///< Of fx / fy, relative [1].
  double principal_point = 7.0;  ///< Of each camera by itself, per axis [px].
  /// Of the offset that cameras with the default principal point share, per axis [px]; 0: none.
  /// That is (535.0, 401.7), by the paper's matrix (2), while its corrected ones lie within 5 px of
  /// (512, 384), 1.6 and 1.3 of these standard deviations away. Predictions are right for such
  /// lenses and for lenses that scatter about the default by 15 px (doc/samples.md).
  double shared_principal_point = 14.0;
  double k1 = 0.02;         ///< Of the first distortion coefficient [1].
  double gravity = 0.0524;  ///< Of the accelerometer's up against the floor's normal [rad]: 3 deg.

  /// A corner that may lie up to a metre from its place [0..3]: to test whether it does.
  std::optional<std::size_t> unknown_corner;

  /// Of the LED put on one corner [m].
  double placementOf(std::size_t corner) const {
    return corner == unknown_corner ? 1.0 : placement;
  }
};

/// Cameras that saw the corners, and the corners.
struct RigState {
  std::vector<geometry::Camera> cameras;  ///< In the order of the sightings.
  Corners corners = zeroCorners();        ///< Where the LED was put [m].
};

/// All that was observed of one square, and the statistical model of it: Gaussian errors of the
/// pixels, of the placement of the LED, of the starting intrinsics, and of the accelerometers.
/// Every camera must have seen three corners or four.
class SquareModel {
 public:
  /// @param z_up as in SquareLayout::corners().
  SquareModel(std::vector<CameraSightings> sightings,
              const SquareLayout& layout,
              bool z_up,
              const Uncertainty& uncertainty);

  const std::vector<CameraSightings>& sightings() const { return sightings_; }
  const Corners& nominalCorners() const { return nominal_corners_; }

  /// A model of one of the cameras alone.
  SquareModel only(std::size_t camera) const;

  /// Starting intrinsics, nominal corners, and the given poses.
  RigState start(const std::vector<Eigen::Isometry3d>& world_from_camera) const;

  /// Convergence of a minimisation: kCoarse suffices to compare costs, and is ten times faster.
  enum class Precision { kCoarse, kFine };

  /// Most probable poses, intrinsics and corners (Levenberg-Marquardt, in place).
  /// @returns the sum of the squared whitened residuals; nothing when it cannot be evaluated at the
  /// start: a corner lies behind a camera.
  std::optional<double> refineAll(RigState* state, Precision precision = Precision::kFine) const;

  /// Residuals minus parameters of refineAll(): the mean of its cost if the model is right. The
  /// same for any state.
  int degreesOfFreedom(const RigState& state) const;

  /// Covariance of refineAll(): of the cameras, order and units as in RigCalibration.msg, then of
  /// the corners' horizontal displacements (2 each) [m].
  Eigen::MatrixXd covarianceOfAll(const RigState& state) const;

  /// Covariance, to first order, of poses of least reprojection error at exact intrinsics and
  /// corners (the paper, IV.B), from the same uncertainties, order and units as in
  /// RigCalibration.msg. The cameras are correlated through the corners.
  Eigen::MatrixXd covarianceOfPoses(const RigState& state) const;

  /// sqrt(mean(du^2 + dv^2)) of one camera [px]; infinite when a corner is behind it.
  double reprojectionError(const RigState& state, std::size_t camera) const;

  /// How far a camera's intrinsics are from where they started, in standard deviations, all of
  /// them together (root of the sum of squares).
  double lensDeviation(const RigState& state, std::size_t camera) const;

 private:
  class Problem;

  /// Unit vector away from the floor, in the world.
  Eigen::Vector3d up() const { return Eigen::Vector3d(0.0, 0.0, z_up_ ? 1.0 : -1.0); }

  std::vector<CameraSightings> sightings_;
  SquareLayout layout_;
  bool z_up_;
  Uncertainty uncertainty_;
  Corners nominal_corners_;
};

}  // namespace wiimote_tracker::square
