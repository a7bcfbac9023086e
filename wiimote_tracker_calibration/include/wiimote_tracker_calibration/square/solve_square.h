#pragma once

#include "wiimote_tracker_calibration/square/sightings.h"
#include "wiimote_tracker_calibration/square/square_layout.h"
#include "wiimote_tracker_calibration/square/square_model.h"
#include "wiimote_tracker_calibration/square/suspect_corner.h"

#include <wiimote_tracker_triangulation/geometry/rig.h>

#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker::square {

enum class Method {
  kJoint,      ///< Poses, intrinsics and placement of the corners together, each with its prior.
  kPerCamera,  ///< Each camera's pose alone, intrinsics and corners taken as exact (the paper).
};

struct SolveOptions {
  Method method = Method::kJoint;
  Uncertainty uncertainty;
  /// Least ratio of probabilities between the two poses a camera can have [> 1].
  double branch_odds = 100.0;
};

/// What only a wave tells.
struct WavePart {
  double pixel_stddev = 0.0;                         ///< Of a moving spot, per axis [px].
  double wand_length = 0.0;                          ///< As estimated [m]; 0 without wand.
  double median_speed = 0.0;                         ///< Of the LED [m/s].
  double seconds_seen = 0.0;                         ///< In which two cameras or more saw it [s].
  Eigen::Vector3d extent = Eigen::Vector3d::Zero();  ///< Of the path: principal stddevs [m].
  /// Solution::expected_error after the best rigid motion: independent of the world frame [m].
  double expected_shape_error = 0.0;
};

/// What was solved, from a square, a wave or both.
struct Solution {
  /// Poses, intrinsics, residuals, joint covariance; verdict: what was solved, and how well;
  /// without solved_at and world_frame.
  geometry::Rig rig;
  bool z_up = true;
  /// Displacement of the corners from the layout, as estimated [m]; zero with kPerCamera, and
  /// without a square.
  Corners corner_offsets = zeroCorners();
  /// Of the rig's parameters, without slow errors of the clocks, then of the corners' offsets (2
  /// each), if there is a square; empty with kPerCamera.
  Eigen::MatrixXd joint_covariance;
  /// The corner that contradicts the rest most; nothing when the data cannot tell.
  std::optional<SuspectCorner> suspect;
  /// RMS error of points that the calibration causes, in the box over the square or, of a wave, on
  /// its path [m]. NaN when no two cameras look there.
  double expected_error = 0.0;
  /// Root of chi-squared over its degrees of freedom, and whether it is significant (99.9 %). Of a
  /// wave it is that of corners, places, lengths and priors.
  double misfit = 0.0;
  bool contradicts = false;
  std::vector<std::string> warnings;  ///< One sentence each.
  /// Where the LED was: a point per knot of a wave that was seen, else the corners [m].
  std::vector<Eigen::Vector3d> path;
  std::optional<WavePart> wave;
};

/// Estimates the cameras' poses. A camera that saw three corners is placed by them and its
/// accelerometer, with a warning; others that did not see all four are left out, with a warning
/// that names them.
/// @throws SquareError: fewer than two cameras saw all corners; corners not captured, in one place,
/// on one line, in crossing order; order not the same for all cameras; an unresolved planar
/// ambiguity; cameras that contradict the square, gravity or one another.
Solution solveSquare(const SquareLayout& layout,
                     const std::vector<CameraSightings>& cameras,
                     const SolveOptions& options);

}  // namespace wiimote_tracker::square
