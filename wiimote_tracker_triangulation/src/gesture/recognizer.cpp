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

struct Candidate {
  const std::string* gesture = nullptr;
  double distance = kInfinity;
  double limit = 0.0;  // of the distance
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
  Model model{*shape, kInfinity};
  for (std::size_t i = 0; i < examples_.size(); ++i) {
    if (examples_[i].gesture != example.gesture || examples_[i].zone != example.zone)
      continue;
    const double between = distanceTo(models_[i], model.shape, kInfinity);
    models_[i].nearest = std::min(models_[i].nearest, between);
    model.nearest = std::min(model.nearest, between);
  }
  models_.insert(models_.begin() + (place - examples_.begin()), model);
  examples_.insert(place, example);
}

std::size_t Recognizer::remove(const std::string& gesture) {
  const std::size_t before = examples_.size();
  for (std::size_t i = examples_.size(); i-- > 0;) {
    if (examples_[i].gesture == gesture) {
      examples_.erase(examples_.begin() + static_cast<std::ptrdiff_t>(i));
      models_.erase(models_.begin() + static_cast<std::ptrdiff_t>(i));
    }
  }
  return before - examples_.size();
}

double Recognizer::distanceTo(const Model& model, const Shape& shape, double limit) const {
  return distance(options_.any_heading ? turnedTowards(shape, model.shape) : shape, model.shape,
                  limit);
}

double Recognizer::spreadAt(const Model& model) const {
  // At most: a mistake among the examples must not make everything fit its gesture.
  return std::isinf(model.nearest) ? 0.5 * options_.rejection_distance
                                   : std::min(model.nearest, options_.rejection_distance);
}

std::optional<Recognition> Recognizer::recognize(const Path& path, const std::string& zone) const {
  const std::optional<Shape> shape = shapeOf(path, options_.shape);
  if (!shape)
    return std::nullopt;
  Candidate best;
  Candidate runner_up;
  for (std::size_t i = 0; i < examples_.size();) {
    const std::string& gesture = examples_[i].gesture;
    TwoNearest nearest;
    double spreads = 0.0;
    int known_here = 0;
    for (; i < examples_.size() && examples_[i].gesture == gesture; ++i) {
      if (!examples_[i].zone.empty() && examples_[i].zone != zone)
        continue;
      ++known_here;
      // Larger distances do not change the two nearest.
      nearest.add(distanceTo(models_[i], *shape, nearest.second));
      spreads += spreadAt(models_[i]);
    }
    if (known_here == 0)
      continue;
    const Candidate candidate{&gesture, nearest.mean(),
                              0.5 * options_.rejection_distance + spreads / known_here};
    if (!best.gesture || candidate.distance < best.distance) {
      runner_up = best;
      best = candidate;
    } else if (!runner_up.gesture || candidate.distance < runner_up.distance) {
      runner_up = candidate;
    }
  }
  if (!best.gesture)
    return std::nullopt;
  // The limit of the nearest gesture is that of both, so that the runner-up scores less.
  const auto score = [&](double distance) { return std::exp2(-distance / best.limit); };
  Recognition recognition{*best.gesture, score(best.distance), "", 0.0};
  if (runner_up.gesture) {
    recognition.runner_up = *runner_up.gesture;
    recognition.runner_up_score = score(runner_up.distance);
  }
  return recognition;
}

}  // namespace wiimote_tracker::gesture
