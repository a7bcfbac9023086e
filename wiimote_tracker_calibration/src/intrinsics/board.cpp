#include "wiimote_tracker_calibration/intrinsics/board.h"

#include <wiimote_tracker_msgs/error.h>

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
  std::size_t seen = 0;
  for (const auto& pixel : pixels)
    seen += pixel ? 1 : 0;
  return seen;
}

}  // namespace wiimote_tracker::intrinsics
