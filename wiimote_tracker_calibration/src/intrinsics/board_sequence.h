#pragma once

namespace wiimote_tracker::intrinsics {

/// The order in which the board lights its LEDs, four at a time: each row flashes once, then each
/// column, then the board is dark. Time is counted in steps; a flash fills the start of its step.
/// Row r flashes in step r, column c in step 4 + 4 c. From its row's flash to its column's flash an
/// LED takes 4 + 4 c - r steps, from 1 to 16 and different for each LED, and from there to its
/// row's next flash 17 to 32. So each LED can be identified alone.
namespace sequence {
constexpr double kStep = 0.060;  ///< [s]
constexpr int kSteps = 33;       ///< Of one cycle.
constexpr double kCycle = kSteps * kStep;
constexpr int rowStep(int row) {
  return row;
}
constexpr int columnStep(int column) {
  return 4 + 4 * column;
}
}  // namespace sequence

}  // namespace wiimote_tracker::intrinsics
