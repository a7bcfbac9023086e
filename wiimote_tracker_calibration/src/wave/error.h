#pragma once

#include <wiimote_tracker_triangulation/geometry/error.h>

namespace wiimote_tracker::wave {

/// A recording does not determine the cameras. what() is one sentence: why, and what to do.
struct WaveError : geometry::Error {
  using Error::Error;
};

/// The data contradict one another, or their priors: one of them is wrong.
struct WaveContradiction : WaveError {
  using WaveError::WaveError;
};

/// A wand that was laid down is not as it must be. The cameras agree, so another start of the
/// adjustment would say the same.
struct WandMislaid : WaveError {
  using WaveError::WaveError;
};

}  // namespace wiimote_tracker::wave
