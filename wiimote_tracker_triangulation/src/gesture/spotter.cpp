#include "gesture/spotter.h"

#include <algorithm>
#include <utility>

namespace wiimote_tracker::gesture {
namespace {

double durationOf(const Path& path) {
  return path.back().time - path.front().time;
}

/// Distance between the ends divided by the length of the path [0..1].
double straightness(const Path& path) {
  double length = 0.0;
  for (std::size_t i = 1; i < path.size(); ++i)
    length += (path[i].position - path[i - 1].position).norm();
  return (path.back().position - path.front().position).norm() / length;
}

}  // namespace

std::optional<Spotted> Spotter::add(const PathPoint& point, const Recognize& recognize) {
  if (!motion_.empty() && !(point.time > motion_.back().time))
    return std::nullopt;
  std::optional<Spotted> found = advance(point.time);
  if (motion_.empty())
    next_comparison_ = point.time + options_.shortest;
  motion_.push_back(point);
  motion_.erase(motion_.begin(), std::find_if(motion_.begin(), motion_.end(), [&](const auto& p) {
                  return p.time >= point.time - options_.longest;
                }));
  if (point.time >= next_comparison_) {
    next_comparison_ = point.time + options_.interval;
    if (auto earlier = compare(recognize))
      found = std::move(earlier);
  }
  if (!found && best_ && point.time - best_->path.back().time >= 0.5 * durationOf(best_->path))
    found = report();
  return found;
}

std::optional<Spotted> Spotter::advance(double time) {
  if (motion_.empty() || time - motion_.back().time <= options_.longest_gap)
    return std::nullopt;
  std::optional<Spotted> found = report();
  motion_.clear();
  return found;
}

/// Motion that was reported is not examined again.
std::optional<Spotted> Spotter::report() {
  std::optional<Spotted> spotted = std::exchange(best_, std::nullopt);
  if (spotted) {
    const double end = spotted->path.back().time;
    motion_.erase(motion_.begin(), std::find_if(motion_.begin(), motion_.end(),
                                                [&](const auto& p) { return p.time >= end; }));
  }
  return spotted;
}

bool Spotter::isAfterRest(const PathPoint& beginning) const {
  const double since = beginning.time - options_.rest_time;
  return motion_.front().time <= since &&
         std::all_of(motion_.begin(), motion_.end(), [&](const PathPoint& p) {
           return p.time < since || p.time > beginning.time ||
                  (p.position - beginning.position).norm() <= options_.rest_radius;
         });
}

/// @returns the best match so far if a later one shares no motion with it.
std::optional<Spotted> Spotter::compare(const Recognize& recognize) {
  std::optional<Spotted> earlier;
  const double now = motion_.back().time;
  for (double duration = options_.shortest; duration <= options_.longest * 1.0001;
       duration *= options_.step) {
    if (durationOf(motion_) < duration - options_.interval)
      break;
    const auto first = std::find_if(motion_.begin(), motion_.end(),
                                    [&](const auto& p) { return p.time >= now - duration; });
    Path path(first, motion_.end());
    const std::optional<Recognition> recognition = recognize(path);
    if (!recognition || recognition->score < options_.minimum_score)
      continue;
    if (straightness(path) > options_.straight && !isAfterRest(path.front()))
      continue;
    if (best_ && path.front().time >= best_->path.back().time)
      earlier = report();
    if (!best_ || recognition->score > best_->recognition.score)
      best_ = Spotted{std::move(path), *recognition};
  }
  return earlier;
}

}  // namespace wiimote_tracker::gesture
