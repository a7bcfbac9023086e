#ifndef WIIMOTE_TRACKER_CALIBRATION_SESSION_SESSION_H
#define WIIMOTE_TRACKER_CALIBRATION_SESSION_SESSION_H

#include "wiimote_tracker_calibration/wave/recording.h"

#include <wiimote_tracker_triangulation/geometry/rig.h>

#include <string>
#include <vector>

namespace wiimote_tracker::session {

/// All that was captured to calibrate a rig, and nothing that was computed from it: what is solved
/// depends on this and on the options of solving only.
struct Session {
  std::string world_frame = "world";
  wave::Recording recording;
  /// Regions of the images in which light was ignored while capturing; one entry per camera of the
  /// recording, in its order. Its spots are without them.
  std::vector<std::vector<geometry::ImageMask>> masks;
};

}  // namespace wiimote_tracker::session

#endif  // WIIMOTE_TRACKER_CALIBRATION_SESSION_SESSION_H
