#ifndef WIIMOTE_TRACKER_CALIBRATION_SRC_SESSION_JUDGE_H
#define WIIMOTE_TRACKER_CALIBRATION_SRC_SESSION_JUDGE_H

#include "wiimote_tracker_calibration/session/session.h"
#include "wiimote_tracker_calibration/session/verdict.h"
#include "wiimote_tracker_calibration/square/suspect_corner.h"

#include <wiimote_tracker_triangulation/geometry/rig.h>

#include <optional>

namespace wiimote_tracker::session {

/// What a solver found out beside the rig.
struct Findings {
  bool z_up = true;
  std::optional<square::SuspectCorner> suspect;
  bool doubts = false;  ///< The rig's verdict holds warnings that tell of a worse result.
  /// Expected RMS error of points to one another, where no square says where the world is [m].
  std::optional<double> shape_error;
};

/// @param rig its verdict holds the solver's words.
Verdict judge(const Session& session, const geometry::Rig& rig, const Findings& findings);

}  // namespace wiimote_tracker::session

#endif  // WIIMOTE_TRACKER_CALIBRATION_SRC_SESSION_JUDGE_H
