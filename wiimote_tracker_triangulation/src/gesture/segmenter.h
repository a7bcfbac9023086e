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
  /// @param seen when a camera last saw it [s]. A later position is foretold from its motion, and
  /// is no part of a gesture if the LED is not seen again.
  /// @returns a gesture that has just ended.
  std::optional<Path> add(const PathPoint& point, double seen);
  std::optional<Path> add(const PathPoint& point) { return add(point, point.time); }

  /// Time has gone on to `time` [s] without a position (the LED is hidden or off).
  std::optional<Path> advance(double time);

  /// With Boundary::kButton: it was pressed or released. Positions of times before and after that
  /// may have been added already, or be added later, by less than kButtonDelay; the gesture is the
  /// same. @returns a gesture that has just ended.
  std::optional<Path> button(double time, bool pressed);
  static constexpr double kButtonDelay = 0.5;  // [s]

  /// Forgets everything, as after a jump of time.
  void reset();

 private:
  std::optional<Path> end();
  std::optional<Path> cutAtButton();
  bool isAtRest() const;
  void forgetBefore(double time);

  SegmenterOptions options_;
  Path path_;            // with kRest also the rest before the gesture
  double seen_ = 0.0;    // [s]
  bool moving_ = false;  // with kRest
  // With kButton:
  bool pressed_ = false;
  double begin_ = 0.0;         // when it was pressed last [s]
  std::optional<double> end_;  // released, and not yet all positions before that are known [s]
};

}  // namespace wiimote_tracker::gesture

#endif  // WIIMOTE_TRACKER_TRIANGULATION_GESTURE_SEGMENTER_H
