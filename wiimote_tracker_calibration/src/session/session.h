#ifndef WIIMOTE_TRACKER_CALIBRATION_SESSION_SESSION_H
#define WIIMOTE_TRACKER_CALIBRATION_SESSION_SESSION_H

#include "wiimote_tracker_calibration/wave/recording.h"

#include <wiimote_tracker_triangulation/geometry/rig.h>

#include <string>
#include <vector>

namespace wiimote_tracker::session {

/// All that was captured to calibrate a rig. A solution depends only on this and on the options of
/// the solver.
struct Session {
  std::string world_frame = "world";
  wave::Recording recording;
  /// Masked regions of the images, per camera of the recording. Its spots are without them.
  std::vector<std::vector<geometry::ImageMask>> masks;
};

}  // namespace wiimote_tracker::session

#endif  // WIIMOTE_TRACKER_CALIBRATION_SESSION_SESSION_H
