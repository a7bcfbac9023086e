#pragma once

#include "capture/corner_capture.h"
#include "capture/image.h"
#include "workflow/reply.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker::workflow {

/// The corners of one square, captured one after another. Times [s] are of the images' stamps.
class SquareRun {
 public:
  static constexpr std::size_t kCorners = 4;

  /// "corner 1".
  static std::string nameOf(std::size_t corner);

  SquareRun() = default;
  SquareRun(const std::vector<std::string>& cameras, const capture::CornerCaptureOptions& options)
      : cameras_(cameras), options_(options) {}

  /// Begins to capture the next missing corner, or `retake` again (0..3).
  Reply begin(std::optional<std::size_t> retake, double now);

  /// One image; images in the order of their stamps. It may complete the capture.
  void add(const capture::Image& image);

  /// Advances the time when no image does.
  void update(double now);

  /// Ends the running capture, if any.
  void abandon(const std::string& why);

  /// Drops the corner that was captured last.
  Reply undo();

  /// Continues with corners from a samples file.
  void restore(const std::vector<capture::CapturedCorner>& corners) { corners_ = corners; }

  bool isComplete() const { return corners_.size() == kCorners; }
  const std::vector<capture::CapturedCorner>& corners() const { return corners_; }
  /// Whether all four corners go round clockwise in some camera's image.
  bool isClockwise() const;
  /// The corner that is being captured or was last, counted from 0.
  std::size_t currentCorner() const { return current_corner_; }
  /// The running capture, if any.
  const std::optional<capture::CornerCapture>& capture() const { return capture_; }
  /// How the last capture ended; nothing while it is running, and before the first.
  const std::optional<Reply>& outcome() const { return outcome_; }
  /// What to do next, one sentence.
  std::string next() const;

 private:
  void finish();
  void end(const Reply& outcome);
  std::optional<std::size_t> cornerInSamePlace(const capture::CapturedCorner& corner) const;

  std::vector<std::string> cameras_;
  capture::CornerCaptureOptions options_;
  std::vector<capture::CapturedCorner> corners_;
  std::size_t current_corner_ = 0;
  std::optional<capture::CornerCapture> capture_;
  std::optional<Reply> outcome_;
};

}  // namespace wiimote_tracker::workflow
