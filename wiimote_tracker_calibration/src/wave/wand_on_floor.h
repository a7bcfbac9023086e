#ifndef WIIMOTE_TRACKER_CALIBRATION_SRC_WAVE_WAND_ON_FLOOR_H
#define WIIMOTE_TRACKER_CALIBRATION_SRC_WAVE_WAND_ON_FLOOR_H

#include "state.h"

namespace wiimote_tracker::wave {

/// Where the cameras saw a wand that lay on the floor before it was waved. The images until it was
/// lifted are removed from the recording. Empty if it did not lie there.
/// @throws WaveError: fewer than two cameras saw it, none has an accelerometer, or a camera saw two
/// lights at rest that are not it.
FloorSpots takeFloor(Recording* recording);

/// Whether the wand is far from how it must lie, by rough cameras in metres, before the adjustment.
/// @throws WaveError: see useFloorAsWorld().
void checkStart(const Task& task, const State& state);

/// Moves the state, known up to a rigid motion, into the world of the wand on the floor, which it
/// adds: the LED nearer to the first camera lies at (0, 0, height), the other one on the x axis, z
/// is the mean up of the accelerometers.
/// @throws WandMislaid: the spots are not those of the wand, its ends are about as far from the
/// first camera, or it was not level. WaveContradiction: the accelerometers contradict one another.
void useFloorAsWorld(const Task& task, State* state);

}  // namespace wiimote_tracker::wave

#endif  // WIIMOTE_TRACKER_CALIBRATION_SRC_WAVE_WAND_ON_FLOOR_H
