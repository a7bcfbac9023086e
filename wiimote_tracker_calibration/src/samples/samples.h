#ifndef WIIMOTE_TRACKER_CALIBRATION_SAMPLES_SAMPLES_H
#define WIIMOTE_TRACKER_CALIBRATION_SAMPLES_SAMPLES_H

#include "wiimote_tracker_calibration/wave/recording.h"

#include <wiimote_tracker_triangulation/geometry/rig.h>

#include <string>
#include <vector>

namespace wiimote_tracker::samples {

/// All that was captured to calibrate a rig. A solution depends only on them and on the options of
/// the solver.
struct Samples {
  std::string world_frame = "world";
  wave::Recording recording;
  /// Masked regions of the images, per camera of the recording. Its spots are without them.
  std::vector<std::vector<geometry::ImageMask>> masks;
};

}  // namespace wiimote_tracker::samples

#endif  // WIIMOTE_TRACKER_CALIBRATION_SAMPLES_SAMPLES_H
