#ifndef WIIMOTE_TRACKER_TRIANGULATION_GESTURE_SPOTTER_H
#define WIIMOTE_TRACKER_TRIANGULATION_GESTURE_SPOTTER_H

#include "gesture/recognizer.h"

#include <optional>
#include <string>

namespace wiimote_tracker::gesture {

struct SpotterOptions {
  /// How often the latest motion is compared with the gestures [s, > 0].
  double interval = 0.05;

  /// Durations of gestures that are looked for [s, > 0], and the factor from one to the next [> 1].
  double shortest = 0.5;
  double longest = 4.0;
  double step = 1.25;

  /// Least score of what is reported [0.5..1]. Motion that is no gesture goes on all the time, so
  /// that chance has many tries; hence more than for a path that was marked as one.
  double minimum_score = 0.7;

  /// All motion is full of straight strokes. One whose ends are further apart than this share of
  /// its length [0..1] is a gesture only after a rest: all positions of the rest_time [s, > 0]
  /// before it within rest_radius [m, > 0] of its beginning.
  double straight = 0.8;
  double rest_time = 0.25;
  double rest_radius = 0.015;

  /// A hole of this length in the motion ends it [s, > 0].
  double longest_hole = 0.15;
};

/// A gesture found in motion that goes on.
struct Spotted {
  Path path;
  Recognition recognition;
};

/// Finds gestures in the motion of one LED without any sign of where they begin and end: the motion
/// of the latest moments, over several durations, is compared with the gestures; the best fit of
/// overlapping ones is reported, once nothing better has come for half of its duration.
class Spotter {
 public:
  explicit Spotter(const SpotterOptions& options) : options_(options) {}

  /// A position of the LED; times must increase, others are ignored.
  std::optional<Spotted> add(const PathPoint& point,
                             const Recognizer& recognizer,
                             const std::string& zone = "");

  /// Time has gone on to `time` [s] without a position (the LED is hidden or off).
  std::optional<Spotted> advance(double time);

  /// Forgets everything, as after a jump of time.
  void reset();

 private:
  std::optional<Spotted> report();
  bool isAfterRest(const PathPoint& beginning) const;
  void look(const Recognizer& recognizer, const std::string& zone);

  SpotterOptions options_;
  Path motion_;
  double next_look_ = 0.0;
  std::optional<Spotted> best_;  // of those that overlap, not yet reported
};

}  // namespace wiimote_tracker::gesture

#endif  // WIIMOTE_TRACKER_TRIANGULATION_GESTURE_SPOTTER_H
