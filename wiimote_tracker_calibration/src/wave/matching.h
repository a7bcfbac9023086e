#ifndef WIIMOTE_TRACKER_CALIBRATION_SRC_WAVE_MATCHING_H
#define WIIMOTE_TRACKER_CALIBRATION_SRC_WAVE_MATCHING_H

#include "state.h"

#include "wiimote_tracker_calibration/wave/recording.h"

#include <cstddef>
#include <vector>

namespace wiimote_tracker::wave {

/// How far a spot may be from where the LED should be seen.
struct Gate {
  double pixel_stddev;  ///< Of a spot, per axis [px].
  double stamp_stddev;  ///< Of its time [s].
  double limit;         ///< [standard deviations]
};

/// Which spots are LEDs.
struct Matching {
  std::vector<Match> matches;
  std::vector<std::size_t>
      expected;                    ///< Per camera: LEDs it could have seen, in frames with spots.
  std::vector<std::size_t> found;  ///< Per camera: matches.
};

/// For each frame the spots that fit best to where the state has the LEDs, one per LED. Only at
/// times at which two cameras or more see an LED: what one sees alone cannot contradict the path.
Matching matchSpots(const Recording& recording, const State& state, const Gate& gate);

}  // namespace wiimote_tracker::wave

#endif  // WIIMOTE_TRACKER_CALIBRATION_SRC_WAVE_MATCHING_H
