#pragma once

#include "wiimote_tracker_calibration/wave/solve_wave.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker::samples {

/// A mistake that may have been made: the recording without it, or with the quantity free.
struct Hypothesis {
  wave::Recording recording;
  square::Uncertainty uncertainty;
  std::function<std::string(const square::Solution&)> describe = nullptr;  ///< One sentence.
  double factor = 1.0;                                                     ///< On the misfit.
};

using Hypotheses = std::vector<Hypothesis>;

/// A corner elsewhere, other sides, a wrong length by tape, another wand; the accelerometer, clock
/// or mirrored image of a camera; cameras exchanged. @param free solved with corners far from their
/// places, if any.
Hypotheses likelyMistakes(const Hypothesis& as_is, const std::optional<square::Solution>& free);

/// A camera that moved between the corners and the wave; none without both.
Hypotheses movedCameras(const Hypothesis& as_is);

/// A camera that contradicts all others.
Hypotheses wrongCameras(const Hypothesis& as_is);

}  // namespace wiimote_tracker::samples
