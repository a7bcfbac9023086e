#ifndef WIIMOTE_TRACKER_CALIBRATION_SRC_WAVE_SOLUTION_H
#define WIIMOTE_TRACKER_CALIBRATION_SRC_WAVE_SOLUTION_H

#include "matching.h"
#include "state.h"

#include "wiimote_tracker_calibration/wave/recording.h"
#include "wiimote_tracker_calibration/wave/solve_wave.h"

namespace wiimote_tracker::wave {

/// What an adjusted state says of the cameras, the corners, the wand and the path, and how certain
/// it is: a solution but for noise, iterations, warnings and verdict.
/// @param matching that the state was adjusted to. @throws WaveError when it leaves some parameter
/// open.
WaveSolution solutionOf(const Recording& recording,
                        const WaveOptions& options,
                        const State& state,
                        const Matching& matching);

}  // namespace wiimote_tracker::wave

#endif  // WIIMOTE_TRACKER_CALIBRATION_SRC_WAVE_SOLUTION_H
