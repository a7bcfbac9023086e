#pragma once

#include "state.h"

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

/// The steps of solveWave(), in their order; the adjustment itself is in adjustment.h.
namespace wiimote_tracker::wave {

/// Where the cameras saw a wand that lay on the floor before it was waved. The images until it was
/// lifted are removed from the recording. Empty if it did not lie there.
/// @throws WaveError: fewer than two cameras saw it, none has an accelerometer, or a camera saw two
/// lights at rest that are not it.
FloorSpots takeFloor(Recording* recording);

/// @throws WaveError: too few data; neither square nor wand.
void checkInput(const Recording& recording);

/// Rough poses of the cameras (centimetres): with a square in its world, else up to scale.
struct StartPoses {
  std::vector<geometry::Camera> cameras;  ///< In the order of the recording.
  bool z_up = true;                       ///< As in SquareLayout::corners().
  bool from_square = false;               ///< Not from the wave alone.
};

/// From the square where two cameras or more saw all of it; the other cameras from common points
/// of the wave by resection. Without such a square from the wave alone (essential matrix), then
/// aligned with the corners that two cameras saw. A start from the wave alone uses a random sample
/// of points and may be wrong; each `attempt` uses other points.
/// @param recording without spots that stay in one place (capture::removeStillSpots()).
/// @throws WaveError, square::SquareError.
StartPoses startPoses(const Recording& recording, const WaveOptions& options, int attempt);

/// The LEDs' path from cameras with rough poses (centimetres), ignoring time offsets. Without a
/// square, the wand's length scales cameras and path. Which of the wand's LEDs is the first is
/// arbitrary, but the same throughout.
/// @param recording without spots that stay in one place (capture::removeStillSpots()).
/// @throws WaveError when there are too few places that two cameras saw.
Trajectory startPath(const Recording& recording,
                     const WaveOptions& options,
                     std::vector<geometry::Camera>* cameras);

/// Refuses a wand that is far from how it must lie, by rough cameras in metres, before the
/// adjustment.
/// @throws WaveError: see useFloorAsWorld().
void checkStart(const Task& task, const State& state);

/// Gate around the predicted spot of an LED.
struct Gate {
  double pixel_stddev;  ///< Of a spot, per axis [px].
  double stamp_stddev;  ///< Of its time [s].
  double limit;         ///< [standard deviations]
};

/// Which spots are LEDs.
struct Matching {
  std::vector<Match> matches;
  /// Per camera: LEDs it could have seen, in frames with spots.
  std::vector<std::size_t> expected;
  std::vector<std::size_t> found;  ///< Per camera: matches.
};

/// For each frame the spots nearest to the predicted ones of the LEDs, one per LED. Only at times
/// at which two cameras or more see an LED: a single camera cannot contradict the path.
Matching matchSpots(const Recording& recording, const State& state, const Gate& gate);

/// @throws WaveError: a camera most of whose spots contradict the others, or with too few.
void checkMatching(const Recording& recording, const Matching& matching);

/// @param gate of the last matching. @param report as of refine(). @param state the solution.
/// @throws WaveError: the clock of a camera jumped during the wave; everything fits better without
/// the jump.
void checkClocks(const Task& task,
                 const Gate& gate,
                 const std::function<void()>& report,
                 State state);

/// @param pixel_stddev of a moving spot, as estimated [px]. @throws WaveContradiction: far more
/// than the options'.
void checkNoise(const WaveOptions& options, double pixel_stddev);

/// Moves the state, known up to a rigid motion, into the world of the wand on the floor, which it
/// adds: the LED nearer to the first camera lies at (0, 0, height), the other one on the x axis, z
/// is the mean up of the accelerometers.
/// @throws WandMislaid: the spots are not those of the wand, its ends are about as far from the
/// first camera, or it was not level. WaveContradiction: the accelerometers contradict one another.
void useFloorAsWorld(const Task& task, State* state);

/// The solution of an adjusted state with its covariance; without warnings and verdict.
/// @param matching that the state was adjusted to. @param redundancy of that. @param pixel_stddev
/// of a moving spot, as estimated [px].
/// @throws WaveError: some parameter is not determined.
square::Solution solutionOf(const Task& task,
                            const State& state,
                            const Matching& matching,
                            double redundancy,
                            double pixel_stddev);

/// Adds warnings to the solution. @throws WaveError: why it must not be used.
void checkSolution(const Task& task, square::Solution* solution);

/// The result in words.
std::string describe(const Recording& recording, const square::Solution& solution);

}  // namespace wiimote_tracker::wave
