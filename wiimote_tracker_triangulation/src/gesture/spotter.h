#pragma once

#include "gesture/recognizer.h"

#include <functional>
#include <optional>

namespace wiimote_tracker::gesture {

struct SpotterOptions {
  /// Period of the comparison with the gestures [s, > 0].
  double interval = 0.05;

  /// Range of tested durations [s, > 0], and the factor between successive ones [> 1].
  double shortest = 0.5;
  double longest = 4.0;
  double step = 1.25;

  /// Least score of a reported gesture [0.5..1]. It is higher than for a segmented path, because
  /// continuous motion offers many chances of a false match.
  double minimum_score = 0.7;

  /// Motion is full of straight strokes. A path whose ends are farther apart than this share of its
  /// length [0..1] counts only after a rest: all positions in the rest_time [s, > 0] before it lie
  /// within rest_radius [m, > 0] of its start.
  double straight = 0.8;
  double rest_time = 0.25;
  double rest_radius = 0.015;

  /// A gap of this length ends the motion [s, > 0].
  double longest_gap = 0.15;
};

/// A gesture found in continuous motion.
struct Spotted {
  Path path;
  Recognition recognition;
};

/// Finds gestures in the continuous motion of one LED. Compares the latest motion with the
/// gestures, over several durations. Of overlapping matches it reports the best, once none was
/// better for half of its duration, or another gesture follows.
class Spotter {
 public:
  explicit Spotter(const SpotterOptions& options) : options_(options) {}

  /// The gesture nearest to a path, as Recognizer::recognize().
  using Recognize = std::function<std::optional<Recognition>(const Path&)>;

  /// Adds a position. Times must increase; others are ignored.
  std::optional<Spotted> add(const PathPoint& point, const Recognize& recognize);

  /// Advances to `time` [s] without a position (the LED is hidden or off).
  std::optional<Spotted> advance(double time);

 private:
  std::optional<Spotted> report();
  bool isAfterRest(const PathPoint& beginning) const;
  std::optional<Spotted> compare(const Recognize& recognize);

  SpotterOptions options_;
  Path motion_;
  double next_comparison_ = 0.0;
  std::optional<Spotted> best_;  // best of the overlapping matches, not yet reported
};

}  // namespace wiimote_tracker::gesture
