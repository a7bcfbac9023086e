#ifndef WIIMOTE_TRACKER_CALIBRATION_SRC_SESSION_JUDGE_H
#define WIIMOTE_TRACKER_CALIBRATION_SRC_SESSION_JUDGE_H

#include "next_measurement.h"
#include "session/session.h"
#include "session/verdict.h"
#include "wiimote_tracker_calibration/square/suspect_corner.h"

#include <wiimote_tracker_triangulation/geometry/rig.h>

#include <Eigen/Core>

#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker::session {

/// What a solver found besides the rig.
struct Findings {
  bool z_up = true;
  std::optional<square::SuspectCorner> suspect;
  bool doubts = false;               ///< The solver warned about the quality.
  bool contradicts = false;          ///< The data contradict one another significantly.
  std::vector<Eigen::Vector3d> led;  ///< Where it was seen, world [m].
  /// Expected RMS error of distances between points, without a square [m].
  std::optional<double> shape_error;
  JointError joint;  ///< Empty covariance: unknown.
};

/// Asks whether the lengths are in metres, if a camera is too far from the LED for a Wii Remote, or
/// too near; else empty. @param led where it was seen, world [m].
std::string scaleQuestion(const wave::Recording& recording,
                          const geometry::Rig& rig,
                          const std::vector<Eigen::Vector3d>& led);

/// The verdict of a rig that was loaded: without predictions for points, which its file lacks.
Verdict verdictOf(const geometry::Rig& rig);

/// Grades a rig. @param rig its verdict is the solver's, and is appended.
Verdict judge(const Session& session, const geometry::Rig& rig, const Findings& findings);

}  // namespace wiimote_tracker::session

#endif  // WIIMOTE_TRACKER_CALIBRATION_SRC_SESSION_JUDGE_H
