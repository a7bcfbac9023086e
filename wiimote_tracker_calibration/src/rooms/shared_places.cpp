#include "rooms/shared_places.h"

#include <wiimote_tracker_triangulation/geometry/point_sensitivity.h>

#include <cstddef>
#include <utility>
#include <vector>

namespace wiimote_tracker::rooms {

namespace {

constexpr std::size_t kFewestPoints = 5;  // In view, of a path with one in 0.1 s.

/// A path in view of two cameras or more, and how its points move with the parameters of the rig.
struct SensitivePath {
  Path path;
  std::vector<Eigen::MatrixXd> by_parameters;
};

SensitivePath sensitivePath(const geometry::Rig& rig, const Path& path) {
  const Eigen::Vector3d velocity = velocityOf(path);
  SensitivePath result;
  for (const PathPoint& point : path) {
    if (const auto derivative = geometry::pointByParameters(
            rig, point.position, geometry::camerasSeeing(rig, point.position), velocity)) {
      result.path.push_back(point);
      result.by_parameters.push_back(*derivative);
    }
  }
  return result;
}

/// A place on the line through a path, and its derivative.
struct Place {
  Eigen::Vector3d position;
  Eigen::MatrixXd by_parameters;
};

Place placeOf(const SensitivePath& path, const Eigen::RowVectorXd& weights) {
  const Eigen::Vector3d position = (weights * positionsOf(path.path)).transpose();
  Eigen::MatrixXd sum = weights[0] * path.by_parameters[0];
  for (std::size_t i = 1; i < path.by_parameters.size(); ++i)
    sum += weights[static_cast<Eigen::Index>(i)] * path.by_parameters[i];
  return {position, sum};
}

/// Axes ahead, to the left and up of somebody who walks.
Eigen::Matrix3d walkersAxes(const Eigen::Vector3d& velocity) {
  Eigen::Matrix3d axes;
  axes.col(0) = velocity.normalized();
  axes.col(1) = Eigen::Vector3d::UnitZ().cross(velocity).normalized();
  axes.col(2) = axes.col(0).cross(axes.col(1));
  return axes;
}

}  // namespace

std::optional<SharedPlaces> sharedPlaces(const geometry::Rig& first,
                                         const geometry::Rig& second,
                                         const Passage& passage,
                                         double slowing) {
  const geometry::Rig& from = passage.from_first ? first : second;
  const geometry::Rig& to = passage.from_first ? second : first;
  const SensitivePath before = sensitivePath(from, passage.before);
  const SensitivePath after = sensitivePath(to, passage.after);
  if (before.path.size() < kFewestPoints || after.path.size() < kFewestPoints)
    return std::nullopt;
  const auto places = hiddenPlaces(before.path, after.path);
  const Eigen::Vector3d velocity = velocityOf(passage.from_first ? before.path : after.path);
  const Eigen::Matrix3d axes = walkersAxes(velocity);
  // Whoever slows down is farther back after the door: in_second against in_first, or the reverse.
  const double hidden = after.path.front().time - before.path.back().time;
  const Eigen::Vector3d back = (passage.from_first ? -hidden : hidden) * slowing * velocity;
  SharedPlaces result;
  for (std::size_t i = 0; i < places.size(); ++i) {
    Place in_first = placeOf(before, places[i].before_weights);
    Place in_second = placeOf(after, places[i].after_weights);
    if (!passage.from_first)
      std::swap(in_first, in_second);
    result[i] = {Eigen::Translation3d(in_first.position) * Eigen::Isometry3d(axes),
                 Eigen::Isometry3d(Eigen::Translation3d(in_second.position)),
                 in_first.by_parameters,
                 in_second.by_parameters,
                 Eigen::Vector3d::Constant(places[i].stddev),
                 back};
  }
  return result;
}

}  // namespace wiimote_tracker::rooms
