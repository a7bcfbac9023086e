#include "wiimote_tracker_calibration/intrinsics/board.h"

#include <algorithm>

namespace wiimote_tracker::intrinsics {

Eigen::Vector3d Board::position(int led) const {
  const int row = led / kBoardColumns;
  return {led % kBoardColumns * column_spacing, row * row_spacing, 0.0};
}

std::size_t BoardView::count() const {
  return static_cast<std::size_t>(
      std::count_if(pixels.begin(), pixels.end(), [](const auto& p) { return p.has_value(); }));
}

}  // namespace wiimote_tracker::intrinsics
