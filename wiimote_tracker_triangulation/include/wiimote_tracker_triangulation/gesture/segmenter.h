#ifndef WIIMOTE_TRACKER_TRIANGULATION_GESTURE_SEGMENTER_H
#define WIIMOTE_TRACKER_TRIANGULATION_GESTURE_SEGMENTER_H

#include "wiimote_tracker_triangulation/gesture/shape.h"

#include <cstddef>
#include <optional>

namespace wiimote_tracker::gesture {

/// What begins and ends a gesture.
enum class Boundary {
  kLight,   ///< The LED is switched on and off.
  kButton,  ///< A button is held down.
  kRest,    ///< The LED is held still before and after.
};

struct SegmenterOptions {
  Boundary boundary = Boundary::kRest;

  /// An LED unseen for longer is switched off [s, > 0].
  double dark_time = 0.15;

  /// Held still: all positions of the last rest_time [s, > 0] within a sphere of rest_radius [m, >
  /// 0] about the newest.
  double rest_time = 0.25;
  double rest_radius = 0.015;

  /// A gesture that lasts longer is cut off at its beginning [s, > 0].
  double maximum_duration = 10.0;

  /// A shorter one is none [s, > 0].
  double minimum_duration = 0.15;
};

/// Cuts the way of one LED into gestures. Time is the positions' own.
class Segmenter {
 public:
  explicit Segmenter(const SegmenterOptions& options) : options_(options) {}

  /// A position of the LED; times must increase, others are ignored.
  /// @returns a gesture that has just ended.
  std::optional<Path> add(const PathPoint& point);

  /// Time has gone on to `time` [s] without a position (the LED is hidden or off).
  std::optional<Path> advance(double time);

  /// @returns a gesture that has just ended, with Boundary::kButton.
  std::optional<Path> button(double time, bool pressed);

  /// Forgets everything, as after a jump of time.
  void reset();

 private:
  std::optional<Path> end();
  bool isAtRest() const;
  void forgetBefore(double time);

  SegmenterOptions options_;
  Path path_;            // with kRest also the rest before the gesture
  bool moving_ = false;  // with kRest
  bool pressed_ = false;
};

}  // namespace wiimote_tracker::gesture

#endif  // WIIMOTE_TRACKER_TRIANGULATION_GESTURE_SEGMENTER_H
