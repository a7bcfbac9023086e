#ifndef WIIMOTE_TRACKER_CALIBRATION_SRC_WAVE_CLOCK_STEP_H
#define WIIMOTE_TRACKER_CALIBRATION_SRC_WAVE_CLOCK_STEP_H

#include "state.h"

#include <vector>

namespace wiimote_tracker::wave {

/// A jump of one camera's clock during the wave.
struct ClockStep {
  double after = 0.0;      ///< Stamp of the last image before the jump [s].
  double size = 0.0;       ///< How much too late the stamps after it are [s].
  double explained = 0.0;  ///< Part of the squared residuals that it explains [px^2].
  double squared = 0.0;    ///< Sum of the camera's squared residuals [px^2].
};

/// For each camera the jump that explains the residuals along the motion of its spots best (the
/// change point of a mean, Hinkley 1970). The path follows a jump in part, so that the size is too
/// small.
std::vector<ClockStep> clockSteps(const State& state, const std::vector<Match>& matches);

}  // namespace wiimote_tracker::wave

#endif  // WIIMOTE_TRACKER_CALIBRATION_SRC_WAVE_CLOCK_STEP_H
