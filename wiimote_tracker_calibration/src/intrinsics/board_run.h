#ifndef WIIMOTE_TRACKER_CALIBRATION_INTRINSICS_BOARD_RUN_H
#define WIIMOTE_TRACKER_CALIBRATION_INTRINSICS_BOARD_RUN_H

#include "intrinsics/board_decoder.h"
#include "intrinsics/view_collector.h"

#include <Eigen/Core>

#include <limits>
#include <string>
#include <vector>

namespace wiimote_tracker::intrinsics {

/// Collects views of the board from one camera's images: a view is kept automatically when the
/// board was held still and the view differs from those kept.
class BoardRun {
 public:
  /// As ViewCollector(). @throws Error: board or image size out of range.
  BoardRun(const Board& board, int width, int height, int minimum_views);

  /// One image, as BoardDecoder::add. @returns whether message() or the views changed.
  bool add(double time, const std::vector<Eigen::Vector2d>& spots);

  /// Removes the last view, if any.
  void undo();

  /// What the camera sees, or whether the latest view was kept; one sentence.
  const std::string& message() const { return message_; }

  Coverage coverage() const { return collector_.coverage(); }
  const Samples& samples() const { return collector_.samples(); }

 private:
  BoardDecoder decoder_;
  ViewCollector collector_;
  std::string message_ = "hold the board still in front of the camera";
  double next_reading_ = -std::numeric_limits<double>::infinity();
};

}  // namespace wiimote_tracker::intrinsics

#endif  // WIIMOTE_TRACKER_CALIBRATION_INTRINSICS_BOARD_RUN_H
