#ifndef WIIMOTE_TRACKER_CALIBRATION_SRC_WAVE_SOLUTION_H
#define WIIMOTE_TRACKER_CALIBRATION_SRC_WAVE_SOLUTION_H

#include "matching.h"
#include "state.h"

namespace wiimote_tracker::wave {

/// The solution of an adjusted state with its covariance; without warnings and verdict.
/// @param matching that the state was adjusted to. @param redundancy of that. @param pixel_stddev
/// of a moving spot, as estimated [px].
/// @throws WaveError: some parameter is not determined.
square::Solution solutionOf(const Task& task,
                            const State& state,
                            const Matching& matching,
                            double redundancy,
                            double pixel_stddev);

}  // namespace wiimote_tracker::wave

#endif  // WIIMOTE_TRACKER_CALIBRATION_SRC_WAVE_SOLUTION_H
