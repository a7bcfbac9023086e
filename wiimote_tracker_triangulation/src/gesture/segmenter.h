#pragma once

#include "wiimote_tracker_triangulation/gesture/shape.h"

#include <optional>

namespace wiimote_tracker::gesture {

/// What starts and ends a gesture.
enum class Boundary {
  kLight,   ///< The LED is switched on and off.
  kButton,  ///< A button is held down.
  kRest,    ///< The LED is held still before and after.
};

struct SegmenterOptions {
  Boundary boundary = Boundary::kRest;

  /// An LED unseen for longer counts as switched off [s, > 0].
  double dark_time = 0.15;

  /// At rest: all positions of the last rest_time [s, > 0] are within rest_radius [m, > 0] of the
  /// newest.
  double rest_time = 0.25;
  double rest_radius = 0.015;

  /// The start of a longer gesture is cut off [s, > 0].
  double maximum_duration = 10.0;

  /// Shorter gestures are ignored [s, > 0].
  double minimum_duration = 0.15;
};

/// Cuts the path of one LED into gestures. Times are those of the positions.
class Segmenter {
 public:
  explicit Segmenter(const SegmenterOptions& options) : options_(options) {}

  /// Adds a position. Times must increase; others are ignored.
  /// @param seen time of the last detection [s]. Later positions are predictions, which belong to a
  /// gesture only if the LED is seen again.
  /// @returns a gesture that this position ends.
  std::optional<Path> add(const PathPoint& point, double seen);

  /// Advances to `time` [s] without a position (the LED is hidden or off).
  std::optional<Path> advance(double time);

  /// With Boundary::kButton: the button was pressed or released. The call may come before or after
  /// the positions of its time, by less than kButtonDelay.
  /// @returns a gesture that this event ends.
  std::optional<Path> button(double time, bool pressed);
  static constexpr double kButtonDelay = 0.5;  // [s]

 private:
  std::optional<Path> end();
  std::optional<Path> cutAtButton();
  bool isAtRest() const;
  void forgetBefore(double time);

  SegmenterOptions options_;
  Path path_;            // with kRest including the rest before the gesture
  double seen_ = 0.0;    // [s]
  bool moving_ = false;  // with kRest
  // With kButton:
  bool is_pressed_ = false;
  double pressed_at_ = 0.0;            // the last time [s]
  std::optional<double> released_at_;  // while earlier positions are awaited [s]
};

}  // namespace wiimote_tracker::gesture
