#ifndef WIIMOTE_TRACKER_CALIBRATION_SRC_WAVE_CHECKS_H
#define WIIMOTE_TRACKER_CALIBRATION_SRC_WAVE_CHECKS_H

#include "matching.h"

#include "wiimote_tracker_calibration/wave/recording.h"
#include "wiimote_tracker_calibration/wave/solve_wave.h"

#include <string>

namespace wiimote_tracker::wave {

/// @throws WaveError: too few data; neither square nor wand.
void checkInput(const Recording& recording);

/// @throws WaveError: a camera most of whose spots contradict the others, or with too few.
void checkMatching(const Recording& recording, const Matching& matching);

/// @param pixel_stddev of a moving spot, as estimated [px]. @throws WaveContradiction: far more
/// than the options'.
void checkNoise(const WaveOptions& options, double pixel_stddev);

/// Adds warnings to the solution. @throws WaveError: why it must not be used.
void checkSolution(const Task& task, square::Solution* solution);

/// The result in words.
std::string describe(const Recording& recording, const square::Solution& solution);

}  // namespace wiimote_tracker::wave

#endif  // WIIMOTE_TRACKER_CALIBRATION_SRC_WAVE_CHECKS_H
