#pragma once

#include <wiimote_tracker_triangulation/geometry/error.h>

namespace wiimote_tracker::square {

/// A square cannot be solved. what() is one sentence: why, and what to do.
struct SquareError : geometry::Error {
  using Error::Error;
};

/// The data contradict one another, or their priors: one of them is wrong.
struct SquareContradiction : SquareError {
  using SquareError::SquareError;
};

}  // namespace wiimote_tracker::square
