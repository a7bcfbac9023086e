#pragma once

#include "samples/solve_samples.h"

#include <cstddef>
#include <optional>
#include <string>

namespace wiimote_tracker::samples {

/// The most likely mistake.
struct Mistake {
  std::string text;                   ///< One sentence: what, its size, what to do.
  std::optional<std::size_t> corner;  ///< Captured in the wrong place, 0..3.
};

/// Looks for the mistake behind data that contradict each other: a corner, a side, the wand's
/// length, an accelerometer, a clock, exchanged cameras, a mirrored image, or a camera that moved.
/// Each hypothesis changes the recording, or frees the quantity, and is solved. The one with the
/// least misfit is named with its size; those that leave out a camera, or its corners, are tested
/// only if no other one explains the data well. @param contradicts if not, only the scale is
/// questioned. @returns nothing when no hypothesis explains the data, or the images that are looked
/// at (of 500 or more, every second) do not contradict each other.
std::optional<Mistake> diagnose(const wave::Recording& recording,
                                const SolveOptions& options,
                                bool contradicts,
                                const wave::ProgressCallback& progress);

}  // namespace wiimote_tracker::samples
