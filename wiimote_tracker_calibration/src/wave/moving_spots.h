#ifndef WIIMOTE_TRACKER_CALIBRATION_SRC_WAVE_MOVING_SPOTS_H
#define WIIMOTE_TRACKER_CALIBRATION_SRC_WAVE_MOVING_SPOTS_H

#include "wiimote_tracker_calibration/wave/recording.h"

#include <vector>

namespace wiimote_tracker::wave {

/// The frames without spots that do not move (lamps and their reflections): places at which a large
/// share of the frames has a spot.
std::vector<Frame> movingSpots(const std::vector<Frame>& frames);

}  // namespace wiimote_tracker::wave

#endif  // WIIMOTE_TRACKER_CALIBRATION_SRC_WAVE_MOVING_SPOTS_H
