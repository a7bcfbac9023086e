#ifndef WIIMOTE_TRACKER_CALIBRATION_BENCHMARK_PAPER_PROCEDURE_H
#define WIIMOTE_TRACKER_CALIBRATION_BENCHMARK_PAPER_PROCEDURE_H

#include "wiimote_tracker_calibration/principal_point/correction.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace wiimote_tracker::principal_point {

/// A simulated measurement session of the paper (section V.B): its cube, cameras, square and ten
/// points.
struct PaperSession {
  /// Of the four cameras round the cube, in their order: {0, 1} adjacent, {0, 2} diagonal.
  std::vector<std::size_t> cameras = {0, 1};
  Eigen::Vector2d true_principal_point{512.0, 384.0};     ///< Mean of the cameras' [px].
  double principal_point_stddev = 5.0;                    ///< Among the cameras, per axis [px].
  double focal_stddev = 0.01;                             ///< Among the cameras, relative.
  std::array<double, 5> distortion{};                     ///< Of all cameras.
  bool distortion_known = true;                           ///< By the cameras' starting intrinsics.
  Eigen::Vector2d assumed_principal_point{535.0, 401.7};  ///< Start: the paper's K (2) [px].
  double corner_pixel = 0.2;     ///< Error of a captured corner, per axis [px].
  double point_pixel = 0.3;      ///< Error of a measured point, per axis [px].
  double placement = 0.005;      ///< Of the LED on the corners, per horizontal axis [m].
  CorrectionOptions correction;  ///< Ray model, rounds, step, points, method.
  std::uint64_t seed = 1;
};

/// Mean distance of the ten points from where they are [m].
struct PaperResult {
  double before = 0.0;
  double after = 0.0;
  CorrectionResult correction;
};

/// One session. Points are measured by the method of the correction.
/// @throws geometry::Error when a session cannot be solved, or a point not be measured.
PaperResult runPaperSession(const PaperSession& session);

}  // namespace wiimote_tracker::principal_point

#endif  // WIIMOTE_TRACKER_CALIBRATION_BENCHMARK_PAPER_PROCEDURE_H
