#pragma once

#include "wiimote_tracker_calibration/square/sightings.h"
#include "wiimote_tracker_calibration/square/square_layout.h"
#include "wiimote_tracker_calibration/square/square_model.h"

#include <wiimote_tracker_triangulation/geometry/rig.h>
#include <wiimote_tracker_triangulation/geometry/triangulate.h>

#include <Eigen/Core>

#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace wiimote_tracker::principal_point {

enum class Points {
  kOrigin,      ///< The first corner (the paper, section IV.C).
  kAllCorners,  ///< The mean of all four, as the paper's section VII asks for.
};

struct CorrectionSteps {
  int rounds = 14;     ///< At most [0..1000]; 14 in all of the paper's measurements.
  double limit = 0.0;  ///< Stops when the error of the points is below it [m, >= 0]; 0: never.
  /// Share of the difference by which a principal point moves per round [-1..1, not 0]. A negative
  /// one diverges; benchmarks show that.
  double step = 0.25;
  Points points = Points::kOrigin;
  /// Of the points; kMeanClosest is the paper's "average closest point".
  geometry::TriangulationMethod method = geometry::TriangulationMethod::kMeanClosest;
};

struct CorrectionOptions : CorrectionSteps {
  geometry::RayModel ray_model = geometry::RayModel::kCalibrated;  ///< As in geometry::Rig.
  double virtual_hfov = std::numeric_limits<double>::quiet_NaN();  ///< As in geometry::Rig [rad].
  square::Uncertainty uncertainty;
  double branch_odds = 100.0;  ///< As in square::SolveOptions.
};

/// The rig after a number of rounds of the correction.
struct Round {
  double origin_error = 0.0;  ///< From the ideal to the measured first corner [m].
  double corner_error = 0.0;  ///< RMS of the same over all four corners [m].
  std::vector<Eigen::Vector2d> principal_points;  ///< Per camera [px].
  /// Per camera, ideal less measured in its image, mean over the points that are used [px].
  std::vector<Eigen::Vector2d> differences;
};

/// How a correction went: rounds[0] is before it, rounds[n] after n steps.
struct Trace {
  std::vector<std::string> cameras;  ///< Names, in the order of all per-camera values.
  std::vector<Round> rounds;
};

/// The trace as a text table, one line per round.
std::string table(const Trace& trace);

struct CorrectionResult {
  /// Solved in the last round of the trace, with Method::kPerCamera and the ray model of the
  /// options. Its covariance does not include the correction.
  geometry::Rig rig;
  bool z_up = true;
  Trace trace;
  bool lost = false;                  ///< The last step led to no usable rig of all cameras.
  std::vector<std::string> warnings;  ///< One sentence each.
};

/// Called after each solving with the number of rounds done. What it throws ends the correction.
using RoundCallback = std::function<void(int rounds_done)>;

/// The paper's principal point correction (section IV.C; doc/principal_point.md): solve each
/// camera's pose from the square; measure the origin with the rig; project the difference between
/// the ideal and the measured origin into each camera, by the lens that is being corrected; move
/// its principal point by a quarter of it; again.
///
/// The sign. Write f for the focal length, x for the normalised image of the origin under the
/// solved pose, u for its pixel, c for the principal point that poses are solved with and p for the
/// one that rays are built with. Solving makes u = f x + c. The ray of u leaves at (u - p) / f =
/// x + (c - p) / f: in the image the origin is measured at c - p from its ideal place. So the
/// difference ideal - measured is p - c, and c + (p - c) / 4 closes a quarter of the gap per round;
/// the opposite step widens it.
///
/// The points are triangulated from the pixels that the cameras were solved from. A round takes
/// some hundredths of a second.
/// @throws Error: the points cannot be measured at all, or one camera
/// alone saw one of them.
/// square::SquareError: as solveSquare(), before the first step; later that ends it as `lost`.
CorrectionResult correctPrincipalPoints(const square::SquareLayout& layout,
                                        const std::vector<square::CameraSightings>& cameras,
                                        const CorrectionOptions& options,
                                        const RoundCallback& progress = {});

}  // namespace wiimote_tracker::principal_point
