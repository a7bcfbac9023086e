#include "gesture/segmenter.h"

#include <algorithm>
#include <utility>

namespace wiimote_tracker::gesture {

std::optional<Path> Segmenter::add(const PathPoint& point, double seen) {
  if (!path_.empty() && !(point.time > path_.back().time))
    return std::nullopt;
  std::optional<Path> ended = advance(point.time);
  path_.push_back(point);
  seen_ = seen;
  const bool waits = options_.boundary == Boundary::kButton && !is_pressed_ && !released_at_;
  forgetBefore(point.time - (waits ? kButtonDelay : options_.maximum_duration));
  if (options_.boundary != Boundary::kRest)
    return ended;

  const bool at_rest = isAtRest();
  if (moving_ && at_rest) {
    moving_ = false;
    // Remove the rest at the end.
    const double end_time = point.time - options_.rest_time;
    while (path_.size() > 1 && path_[path_.size() - 2].time >= end_time)
      path_.pop_back();
    ended = end();
    path_.push_back(point);
  } else if (!moving_ && at_rest) {
    forgetBefore(point.time - options_.rest_time);
  } else {
    moving_ = true;
  }
  return ended;
}

std::optional<Path> Segmenter::advance(double time) {
  if (released_at_ && time > *released_at_)
    return cutAtButton();
  if (path_.empty() || time - path_.back().time <= options_.dark_time)
    return std::nullopt;
  while (!path_.empty() && path_.back().time > seen_)
    path_.pop_back();
  // A path with a gap is discarded; with kLight the gap ends the gesture.
  std::optional<Path> ended = end();
  return options_.boundary == Boundary::kLight ? ended : std::nullopt;
}

std::optional<Path> Segmenter::button(double time, bool pressed) {
  if (options_.boundary != Boundary::kButton || pressed == is_pressed_)
    return std::nullopt;
  is_pressed_ = pressed;
  if (pressed) {
    std::optional<Path> ended = released_at_ && *released_at_ < time ? cutAtButton() : std::nullopt;
    released_at_.reset();  // in the future after a restart of a bag
    pressed_at_ = time;
    return ended;
  }
  released_at_ = time;
  return !path_.empty() && path_.back().time >= time ? cutAtButton() : std::nullopt;
}

/// The path between pressing and releasing the button.
std::optional<Path> Segmenter::cutAtButton() {
  forgetBefore(pressed_at_);
  const auto after = std::find_if(path_.begin(), path_.end(),
                                  [&](const PathPoint& p) { return p.time > *released_at_; });
  Path later(after, path_.end());
  path_.erase(after, path_.end());
  released_at_.reset();
  std::optional<Path> ended = end();
  path_ = std::move(later);
  return ended;
}

std::optional<Path> Segmenter::end() {
  Path path = std::exchange(path_, {});
  moving_ = false;
  if (path.size() < 2 || path.back().time - path.front().time < options_.minimum_duration)
    return std::nullopt;
  return path;
}

bool Segmenter::isAtRest() const {
  const PathPoint& newest = path_.back();
  for (std::size_t i = path_.size(); i-- > 0;) {
    if ((path_[i].position - newest.position).norm() > options_.rest_radius)
      return false;
    if (newest.time - path_[i].time >= options_.rest_time)
      return true;
  }
  // Too few positions: an LED that has just appeared may be moving.
  return false;
}

void Segmenter::forgetBefore(double time) {
  const auto first =
      std::find_if(path_.begin(), path_.end(), [&](const PathPoint& p) { return p.time >= time; });
  path_.erase(path_.begin(), first);
}

}  // namespace wiimote_tracker::gesture
