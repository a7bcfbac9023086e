#ifndef WIIMOTE_TRACKER_TRIANGULATION_GESTURE_RECOGNIZER_H
#define WIIMOTE_TRACKER_TRIANGULATION_GESTURE_RECOGNIZER_H

#include "wiimote_tracker_triangulation/gesture/shape.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker::gesture {

struct RecognizerOptions {
  ShapeOptions shape;

  /// The same gesture in another direction of the compass is the same.
  bool any_heading = false;

  /// A path further than this from every gesture is none [1, > 0]; see distance().
  double rejection_distance = 0.65;
};

/// One way in which a gesture was drawn.
struct Example {
  std::string gesture;
  std::string zone;  ///< Only recognised in this zone of the rig; empty: everywhere.
  Path path;
};

/// The gesture that a path resembles most. Scores [0..1]: 1 for the very same shape, 0.5 where it
/// would be rejected.
struct Recognition {
  std::string gesture;
  double score;
  std::string runner_up;         ///< Another gesture; empty when there is none.
  double runner_up_score = 0.0;  ///< 0 when there is none.

  bool accepted() const { return score >= 0.5; }
};

/// Knows gestures by examples: one to a few of each. A path is as far from a gesture as the mean of
/// its distances to the two nearest examples, so that one odd example does little harm.
class Recognizer {
 public:
  explicit Recognizer(const RecognizerOptions& options) : options_(options) {}

  /// @throws Error: no name, or a path without a shape.
  void add(const Example& example);

  /// All examples of a gesture; how many there were.
  std::size_t remove(const std::string& gesture);

  const std::vector<Example>& examples() const { return examples_; }

  /// Nothing when the path has no shape, or no gesture is known in that zone.
  std::optional<Recognition> recognize(const Path& path, const std::string& zone = "") const;

 private:
  RecognizerOptions options_;
  std::vector<Example> examples_;  // those of one gesture side by side
  std::vector<Shape> shapes_;      // parallel to examples_
};

}  // namespace wiimote_tracker::gesture

#endif  // WIIMOTE_TRACKER_TRIANGULATION_GESTURE_RECOGNIZER_H
