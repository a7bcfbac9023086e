#include "drawing.h"

#include <algorithm>
#include <stdexcept>

namespace wiimote_tracker::simulation {

Drawing::Drawing(const gesture::Path& path, double size, double rest) : path_(path), rest_(rest) {
  if (path_.size() < 2)
    throw std::invalid_argument("has fewer than two points; record a longer one");
  const double begin = path_.front().time;
  Eigen::Vector3d low = path_.front().position;
  Eigen::Vector3d high = low;
  for (std::size_t i = 0; i < path_.size(); ++i) {
    if (!path_[i].position.allFinite())
      throw std::invalid_argument("has a position that is not finite; remove that row");
    if (i > 0 && !(path_[i].time - begin > path_[i - 1].time))
      throw std::invalid_argument("has times that do not increase; sort or remove those rows");
    path_[i].time -= begin;
    low = low.cwiseMin(path_[i].position);
    high = high.cwiseMax(path_[i].position);
  }
  const double extent = (high - low).maxCoeff();
  if (!(extent > 0.0))
    throw std::invalid_argument("does not move; record it again");
  for (gesture::PathPoint& point : path_)
    point.position = size / extent * (point.position - 0.5 * (low + high));
  duration_ = path_.back().time;
}

Eigen::Vector3d Drawing::position(double time) const {
  if (time <= 0.0)
    return path_.front().position;
  if (time >= duration_)
    return path_.back().position;
  const auto next = std::upper_bound(path_.begin(), path_.end(), time,
                                     [](double t, const auto& point) { return t < point.time; });
  const auto before = std::prev(next);
  const double share = (time - before->time) / (next->time - before->time);
  return before->position + share * (next->position - before->position);
}

}  // namespace wiimote_tracker::simulation
