#ifndef WIIMOTE_TRACKER_CALIBRATION_SRC_WAVE_MATCHING_H
#define WIIMOTE_TRACKER_CALIBRATION_SRC_WAVE_MATCHING_H

#include "state.h"

#include "wiimote_tracker_calibration/wave/recording.h"

#include <cstddef>
#include <vector>

namespace wiimote_tracker::wave {

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

}  // namespace wiimote_tracker::wave

#endif  // WIIMOTE_TRACKER_CALIBRATION_SRC_WAVE_MATCHING_H
