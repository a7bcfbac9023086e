#ifndef WIIMOTE_TRACKER_CALIBRATION_SRC_WAVE_START_PATH_H
#define WIIMOTE_TRACKER_CALIBRATION_SRC_WAVE_START_PATH_H

#include "trajectory.h"

#include "wiimote_tracker_calibration/wave/recording.h"
#include "wiimote_tracker_calibration/wave/solve_wave.h"

#include <wiimote_tracker_triangulation/geometry/camera.h>

#include <vector>

namespace wiimote_tracker::wave {

/// The LEDs' path from cameras with rough poses (centimetres), ignoring time offsets. Without a
/// square, the wand's length scales cameras and path. Which of the wand's LEDs is the first is
/// arbitrary, but the same throughout.
/// @param recording without spots that stay in one place (capture::removeStillSpots()).
/// @throws WaveError when there are too few places that two cameras saw.
Trajectory startPath(const Recording& recording,
                     const WaveOptions& options,
                     std::vector<geometry::Camera>* cameras);

}  // namespace wiimote_tracker::wave

#endif  // WIIMOTE_TRACKER_CALIBRATION_SRC_WAVE_START_PATH_H
