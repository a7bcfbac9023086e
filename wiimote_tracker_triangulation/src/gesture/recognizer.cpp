#include "gesture/recognizer.h"

#include "wiimote_tracker_triangulation/geometry/error.h"

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

}  // namespace

void Recognizer::add(const Example& example) {
  if (example.gesture.empty())
    throw Error("an example of a gesture has no name; give it one");
  ShapeOptions any_length = options_.shape;
  any_length.minimum_length = 0.0;
  const std::optional<Shape> shape = shapeOf(example.path, any_length);
  if (!shape)
    throw Error("the example of '" + example.gesture + "' with " +
                std::to_string(example.path.size()) +
                " points is too short to be a gesture; draw it again, larger");
  const auto after_its_kind =
      std::find_if(examples_.rbegin(), examples_.rend(),
                   [&](const Example& e) { return e.gesture == example.gesture; });
  const auto place = after_its_kind == examples_.rend() ? examples_.end() : after_its_kind.base();
  shapes_.insert(shapes_.begin() + (place - examples_.begin()), *shape);
  examples_.insert(place, example);
}

std::size_t Recognizer::remove(const std::string& gesture) {
  const std::size_t before = examples_.size();
  for (std::size_t i = examples_.size(); i-- > 0;) {
    if (examples_[i].gesture == gesture) {
      examples_.erase(examples_.begin() + static_cast<std::ptrdiff_t>(i));
      shapes_.erase(shapes_.begin() + static_cast<std::ptrdiff_t>(i));
    }
  }
  return before - examples_.size();
}

std::optional<Recognition> Recognizer::recognize(const Path& path, const std::string& zone) const {
  const std::optional<Shape> shape = shapeOf(path, options_.shape);
  if (!shape)
    return std::nullopt;
  const std::string* best = nullptr;
  const std::string* runner_up = nullptr;
  double best_distance = kInfinity;
  double runner_up_distance = kInfinity;
  for (std::size_t i = 0; i < examples_.size();) {
    const std::string& gesture = examples_[i].gesture;
    TwoNearest nearest;
    bool known_here = false;
    for (; i < examples_.size() && examples_[i].gesture == gesture; ++i) {
      if (!examples_[i].zone.empty() && examples_[i].zone != zone)
        continue;
      known_here = true;
      // Larger distances do not change the two nearest.
      nearest.add(distance(options_.any_heading ? turnedTowards(*shape, shapes_[i]) : *shape,
                           shapes_[i], nearest.second));
    }
    if (!known_here)
      continue;
    if (!best || nearest.mean() < best_distance) {
      runner_up = best;
      runner_up_distance = best_distance;
      best = &gesture;
      best_distance = nearest.mean();
    } else if (!runner_up || nearest.mean() < runner_up_distance) {
      runner_up = &gesture;
      runner_up_distance = nearest.mean();
    }
  }
  if (!best)
    return std::nullopt;
  const auto score = [&](double d) { return std::exp2(-d / options_.rejection_distance); };
  Recognition recognition{*best, score(best_distance), "", 0.0};
  if (runner_up) {
    recognition.runner_up = *runner_up;
    recognition.runner_up_score = score(runner_up_distance);
  }
  return recognition;
}

}  // namespace wiimote_tracker::gesture
