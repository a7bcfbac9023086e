#include "gesture/recognizer.h"

#include "wiimote_tracker_triangulation/geometry/error.h"

#include <wiimote_tracker_msgs/text.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace wiimote_tracker::gesture {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The two smallest distances to the examples of one gesture.
struct TwoNearest {
  double first = kInfinity;
  double second = kInfinity;

  void add(double distance) {
    second = std::min(second, std::max(first, distance));
    first = std::min(first, distance);
  }
  double mean() const { return std::isinf(second) ? first : 0.5 * (first + second); }
};

struct Candidate {
  const std::string* gesture;
  double distance;
  double limit;  // of the distance
};

}  // namespace

void Recognizer::add(const Example& example) {
  if (example.gesture.empty())
    throw Error("an example of a gesture has no name; give it one");
  ShapeOptions any_length = options_.shape;
  any_length.minimum_length = 0.0;
  const std::optional<Shape> shape = shapeOf(example.path, any_length);
  if (!shape)
    throw Error("the example of '" + example.gesture + "' with " +
                counted(example.path.size(), "point") +
                " is too short to be a gesture; draw it again, larger");
  std::vector<Known>& others = gestures_[example.gesture];
  Known known{example, *shape, kInfinity};
  for (Known& other : others) {
    if (other.example.zone != example.zone)
      continue;
    const double between = distanceTo(other, known.shape, kInfinity);
    other.nearest = std::min(other.nearest, between);
    known.nearest = std::min(known.nearest, between);
  }
  others.push_back(known);
}

std::size_t Recognizer::remove(const std::string& gesture) {
  const auto found = gestures_.find(gesture);
  if (found == gestures_.end())
    return 0;
  const std::size_t removed = found->second.size();
  gestures_.erase(found);
  return removed;
}

std::vector<Example> Recognizer::examples() const {
  std::vector<Example> examples;
  for (const auto& [gesture, known] : gestures_) {
    for (const Known& each : known)
      examples.push_back(each.example);
  }
  return examples;
}

double Recognizer::distanceTo(const Known& known, const Shape& shape, double limit) const {
  return distance(options_.any_heading ? turnedTowards(shape, known.shape) : shape, known.shape,
                  limit);
}

double Recognizer::spreadAt(const Known& known) const {
  // At most: a mistake among the examples must not make everything fit its gesture.
  return std::isinf(known.nearest) ? 0.5 * options_.rejection_distance
                                   : std::min(known.nearest, options_.rejection_distance);
}

std::optional<Recognition> Recognizer::recognize(const Path& path, const std::string& zone) const {
  const std::optional<Shape> shape = shapeOf(path, options_.shape);
  if (!shape)
    return std::nullopt;
  std::vector<Candidate> candidates;
  for (const auto& [gesture, examples] : gestures_) {
    TwoNearest nearest;
    double spreads = 0.0;
    int known_here = 0;
    for (const Known& known : examples) {
      if (!known.example.zone.empty() && known.example.zone != zone)
        continue;
      ++known_here;
      // Larger distances do not change the two nearest.
      nearest.add(distanceTo(known, *shape, nearest.second));
      spreads += spreadAt(known);
    }
    if (known_here > 0)
      candidates.push_back(
          {&gesture, nearest.mean(), 0.5 * options_.rejection_distance + spreads / known_here});
  }
  if (candidates.empty())
    return std::nullopt;
  std::sort(candidates.begin(), candidates.end(),
            [](const Candidate& a, const Candidate& b) { return a.distance < b.distance; });
  // The limit of the nearest gesture is that of both, so that the runner-up scores less.
  const Candidate& best = candidates.front();
  const auto score = [&](double distance) { return std::exp2(-distance / best.limit); };
  Recognition recognition{*best.gesture, score(best.distance), "", 0.0};
  if (candidates.size() > 1) {
    recognition.runner_up = *candidates[1].gesture;
    recognition.runner_up_score = score(candidates[1].distance);
  }
  return recognition;
}

}  // namespace wiimote_tracker::gesture
