#ifndef WIIMOTE_TRACKER_CALIBRATION_SRC_WAVE_CLOCK_JUMP_H
#define WIIMOTE_TRACKER_CALIBRATION_SRC_WAVE_CLOCK_JUMP_H

#include "matching.h"
#include "state.h"

#include <functional>

namespace wiimote_tracker::wave {

/// @param gate of the last matching. @param report as of refine(). @param state the solution.
/// @throws WaveError: the clock of a camera jumped during the wave; everything fits better without
/// the jump.
void checkClocks(const Task& task,
                 const Gate& gate,
                 const std::function<void()>& report,
                 State state);

}  // namespace wiimote_tracker::wave

#endif  // WIIMOTE_TRACKER_CALIBRATION_SRC_WAVE_CLOCK_JUMP_H
