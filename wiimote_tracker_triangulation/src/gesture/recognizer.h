#pragma once

#include "wiimote_tracker_triangulation/gesture/shape.h"

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker::gesture {

struct RecognizerOptions {
  ShapeOptions shape;

  /// Whether a gesture is recognised in any heading (rotation about the vertical).
  bool any_heading = false;

  /// Paths farther than this from a gesture with one example are rejected [1, > 0]; see distance().
  /// With several, the limit is half of this plus the mean distance from an example to the nearest
  /// other one, each at most this.
  double rejection_distance = 0.65;
};

struct Example {
  std::string gesture;
  std::string zone;  ///< Zone of the rig to which it is limited; empty: none.
  Path path;
};

/// The gesture nearest to a path. Scores [0..1]: 1 for an equal shape, 0.5 at the limit of the
/// nearest gesture, beyond which the path is rejected.
struct Recognition {
  std::string gesture;
  double score;
  std::string runner_up;         ///< The next gesture; empty: none.
  double runner_up_score = 0.0;  ///< 0: none.

  bool accepted() const { return score >= 0.5; }
};

/// Recognises gestures by one or a few examples of each. The distance of a path to a gesture is the
/// mean over the two nearest examples, which limits the effect of an odd example. Its limit is
/// stricter for a gesture that people draw alike, such as a stroke, than for one that everybody
/// draws in another way, such as a spiral.
class Recognizer {
 public:
  explicit Recognizer(const RecognizerOptions& options) : options_(options) {}

  /// Of any length: shapes have no scale. @throws Error: no name, or a path without a shape.
  void add(const Example& example);

  /// Removes all examples of a gesture. @returns their number.
  std::size_t remove(const std::string& gesture);

  /// In the order of their gestures' names.
  std::vector<Example> examples() const;

  /// Nothing when the path has no shape, or the zone has no gesture.
  std::optional<Recognition> recognize(const Path& path, const std::string& zone = "") const;

 private:
  struct Known {
    Example example;
    Shape shape;
    double nearest;  // distance to the nearest other example of its gesture and zone, or infinity
  };

  double distanceTo(const Known& known, const Shape& shape, double limit) const;

  /// Distance to the nearest other example, as it counts for the limit of the gesture.
  double spreadAt(const Known& known) const;

  RecognizerOptions options_;
  std::map<std::string, std::vector<Known>> gestures_;  // by name
};

}  // namespace wiimote_tracker::gesture
