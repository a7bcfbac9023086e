#ifndef WIIMOTE_TRACKER_CALIBRATION_SRC_WAVE_START_PATH_H
#define WIIMOTE_TRACKER_CALIBRATION_SRC_WAVE_START_PATH_H

#include "start_poses.h"
#include "trajectory.h"

#include "wiimote_tracker_calibration/wave/recording.h"
#include "wiimote_tracker_calibration/wave/solve_wave.h"

namespace wiimote_tracker::wave {

/// The LEDs' path as cameras that stand roughly right see it (centimetres), without regard to time
/// offsets. Where it starts not to be metric the wand makes it so, cameras included.
/// The wand's LEDs look alike: which is the first of the two is arbitrary, but stays.
/// @param recording without spots that stay in one place (movingSpots()).
/// @throws WaveError when there are too few places that two cameras saw.
Trajectory startPath(const Recording& recording, const WaveOptions& options, StartPoses* poses);

}  // namespace wiimote_tracker::wave

#endif  // WIIMOTE_TRACKER_CALIBRATION_SRC_WAVE_START_PATH_H
