#ifndef WIIMOTE_TRACKER_CALIBRATION_INTRINSICS_BOARD_RUN_H
#define WIIMOTE_TRACKER_CALIBRATION_INTRINSICS_BOARD_RUN_H

#include "wiimote_tracker_calibration/intrinsics/board_decoder.h"
#include "wiimote_tracker_calibration/intrinsics/view_collector.h"

#include <Eigen/Core>

#include <limits>
#include <string>
#include <vector>

namespace wiimote_tracker::intrinsics {

/// Views of the board from one camera's images: one is kept by itself whenever the board is held
/// still where it adds something.
class BoardRun {
 public:
  /// @throws IntrinsicsError: board, image size or options out of range.
  BoardRun(const Board& board, int width, int height, const CollectorOptions& options);

  /// One image, as BoardDecoder::add. @returns whether there is news.
  bool add(double time, const std::vector<Eigen::Vector2d>& spots);

  /// Takes back the last view, if any.
  void undo();

  /// What the camera sees, or what became of the latest view; one sentence.
  const std::string& message() const { return message_; }

  Coverage coverage() const { return collector_.coverage(); }
  const Samples& samples() const { return collector_.samples(); }

 private:
  BoardDecoder decoder_{DecoderOptions()};
  ViewCollector collector_;
  std::string message_ = "hold the board still in front of the camera";
  double next_reading_ = -std::numeric_limits<double>::infinity();
};

}  // namespace wiimote_tracker::intrinsics

#endif  // WIIMOTE_TRACKER_CALIBRATION_INTRINSICS_BOARD_RUN_H
