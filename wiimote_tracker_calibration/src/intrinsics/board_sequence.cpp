#include "intrinsics/board_sequence.h"

#include "wiimote_tracker_calibration/intrinsics/board.h"

#include <cmath>

namespace wiimote_tracker::intrinsics::sequence {

bool isLit(int led, double time) {
  const double in_cycle = std::fmod(time, kCycle);
  const int step = static_cast<int>(in_cycle / kStep);
  const bool has_turn =
      step == rowStep(led / kBoardColumns) || step == columnStep(led % kBoardColumns);
  return has_turn && in_cycle - step * kStep < kFlash;
}

}  // namespace wiimote_tracker::intrinsics::sequence
