#pragma once

#include "intrinsics/board_decoder.h"

#include <Eigen/Core>

#include <limits>
#include <string>
#include <vector>

namespace wiimote_tracker::intrinsics {

/// Variety of the views, as four bars like those of ROS' camera_calibration.
/// x and y are full when the board covered 0.7 of its range from edge to edge; size when the
/// largest view covers 0.16 of the image; skew when an angle of a view is 0.25 rad from a right
/// one.
struct Coverage {
  double x = 0.0;                    ///< [0 to 1]
  double y = 0.0;                    ///< [0 to 1]
  double size = 0.0;                 ///< [0 to 1]
  double skew = 0.0;                 ///< [0 to 1]
  std::vector<std::string> missing;  ///< What to do, one sentence each.
  bool enough() const { return missing.empty(); }
};

/// Collects views of the board from one camera's images: those in which it was held still, and that
/// differ from all kept before.
class ViewCollector {
 public:
  /// @param minimum_views that are enough [> 0]. @throws Error: board or image size out of range.
  ViewCollector(const Board& board, int width, int height, int minimum_views);

  /// One image, as BoardDecoder::add. @returns whether message() or the views changed.
  bool addImage(double time, const std::vector<Eigen::Vector2d>& spots);

  /// What the camera sees, or whether the latest view was kept; one sentence.
  const std::string& message() const { return message_; }

  /// Keeps the view, or says why not.
  /// @returns empty when it was kept, else one sentence.
  std::string add(const BoardView& view);

  /// Removes the last view kept, if any.
  void undo();

  Coverage coverage() const;
  const Samples& samples() const { return samples_; }

 private:
  using Parameters = Eigen::Array4d;  // x, y, size, skew [0 to 1]

  BoardDecoder decoder_;
  std::string message_ = "hold the board still in front of the camera";
  double next_reading_ = -std::numeric_limits<double>::infinity();  // [s]
  Samples samples_;
  int minimum_views_;
  std::vector<Parameters> parameters_;  // of samples_.views
};

}  // namespace wiimote_tracker::intrinsics
