#include "wiimote_tracker_calibration/intrinsics/board.h"

#include <wiimote_tracker_msgs/error.h>

#include <algorithm>
#include <cmath>

namespace wiimote_tracker::intrinsics {

Eigen::Vector3d Board::position(int led) const {
  return {led % kBoardColumns * column_spacing, led / kBoardColumns * row_spacing, 0.0};
}

void Board::check() const {
  for (const double spacing : {column_spacing, row_spacing}) {
    if (!(std::isfinite(spacing) && spacing > 0.0))
      throw Error("the board's spacings must be above 0 m: measure them");
  }
}

std::size_t BoardView::count() const {
  return static_cast<std::size_t>(
      std::count_if(pixels.begin(), pixels.end(), [](const auto& p) { return p.has_value(); }));
}

}  // namespace wiimote_tracker::intrinsics
