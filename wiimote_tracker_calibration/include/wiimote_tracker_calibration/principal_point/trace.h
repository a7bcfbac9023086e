#ifndef WIIMOTE_TRACKER_CALIBRATION_PRINCIPAL_POINT_TRACE_H
#define WIIMOTE_TRACKER_CALIBRATION_PRINCIPAL_POINT_TRACE_H

#include <Eigen/Core>

#include <string>
#include <vector>

namespace wiimote_tracker::principal_point {

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

}  // namespace wiimote_tracker::principal_point

#endif  // WIIMOTE_TRACKER_CALIBRATION_PRINCIPAL_POINT_TRACE_H
