#ifndef WIIMOTE_TRACKER_CALIBRATION_SRC_SESSION_JUDGE_H
#define WIIMOTE_TRACKER_CALIBRATION_SRC_SESSION_JUDGE_H

#include "session/session.h"
#include "session/verdict.h"
#include "wiimote_tracker_calibration/square/suspect_corner.h"

#include <wiimote_tracker_triangulation/geometry/rig.h>

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace wiimote_tracker::session {

/// What a solver found besides the rig.
struct Findings {
  bool z_up = true;
  std::optional<square::SuspectCorner> suspect;
  bool doubts = false;               ///< The solver warned about the quality.
  std::vector<Eigen::Vector3d> led;  ///< Where it was seen, world [m].
  /// Expected RMS error of distances between points, without a square [m].
  std::optional<double> shape_error;
};

/// Grades a rig. @param rig its verdict is the solver's, and is appended.
Verdict judge(const Session& session, const geometry::Rig& rig, const Findings& findings);

}  // namespace wiimote_tracker::session

#endif  // WIIMOTE_TRACKER_CALIBRATION_SRC_SESSION_JUDGE_H
