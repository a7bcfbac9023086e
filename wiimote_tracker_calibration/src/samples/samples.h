#pragma once

#include "wiimote_tracker_calibration/wave/recording.h"

#include <string>

namespace wiimote_tracker::samples {

/// All that was captured to calibrate a rig. A solution depends only on them and on the options of
/// the solver.
struct Samples {
  std::string world_frame = "world";
  wave::Recording recording;
};

}  // namespace wiimote_tracker::samples
