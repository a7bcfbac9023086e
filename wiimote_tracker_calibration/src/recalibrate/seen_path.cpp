#include "seen_path.h"

#include <wiimote_tracker_triangulation/geometry/triangulate.h>

#include <utility>

namespace wiimote_tracker::recalibrate {

namespace {

// The velocity is a central difference over twice this [s].
constexpr double kStep = 0.02;
// Largest RMS reprojection error of one light [px]; larger where a time offset is unknown.
constexpr double kLargestMiss = 6.0;
constexpr double kLargestMissUnclocked = 20.0;
// Largest standard deviation of a point for 1 px [m]: cameras that face each other hardly determine
// the position on the line between them.
constexpr double kLargestSpread = 0.02;

}  // namespace

SeenPath::SeenPath(const geometry::Rig& rig,
                   const std::vector<capture::Image>& images,
                   const std::string& without) {
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    const geometry::RigCamera& camera = rig.cameras[i];
    Track track;
    track.rays = rig.rayCamera(camera);
    if (camera.camera.name != without) {
      for (const capture::Image& image : capture::imagesOf(camera.camera.name, images)) {
        const auto offset = camera.timeOffsetIn(image.clock_epoch);
        track.clock_known = offset.has_value();
        capture::append(image.stamp + offset.value_or(0.0), image, &track.spots);
      }
    }
    if (!track.spots.empty())
      seeing_.push_back(i);
    tracks_.push_back(std::move(track));
  }
}

SeenPath::Sight SeenPath::positionAt(double time, PathPoint* point) const {
  std::vector<geometry::Observation> observations;
  point->cameras.clear();
  double largest_miss = kLargestMiss;
  for (const std::size_t i : seeing_) {
    const Track& track = tracks_[i];
    const auto found = capture::bracket(track.spots, time);
    if (!found)
      continue;
    const Eigen::Vector2d step = found->after->pixel - found->before->pixel;
    observations.push_back({&track.rays, found->before->pixel + found->shareAt(time) * step});
    point->cameras.push_back(i);
    if (!track.clock_known)
      largest_miss = kLargestMissUnclocked;
  }
  if (observations.size() < 2)
    return Sight::kNotSeen;
  geometry::TriangulationOptions options;
  options.pixel_stddev = 1.0;
  auto result = geometry::triangulate(observations, options);
  // Of three or more, leave one out if it sees another light.
  if (observations.size() > 2 && (!result || result->reprojection_error > largest_miss)) {
    std::size_t left_out = 0;
    for (std::size_t i = 0; i < observations.size(); ++i) {
      std::vector<geometry::Observation> others = observations;
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
      const auto without = geometry::triangulate(others, options);
      if (without && (!result || without->reprojection_error < result->reprojection_error)) {
        result = without;
        left_out = i;
      }
    }
    point->cameras.erase(point->cameras.begin() + static_cast<std::ptrdiff_t>(left_out));
  }
  if (!result || result->reprojection_error > largest_miss)
    return Sight::kContradictory;
  if (result->covariance.trace() > kLargestSpread * kLargestSpread)
    return Sight::kUndetermined;
  point->position = result->position;
  point->unit_covariance = result->covariance;
  return Sight::kSeen;
}

SeenPath::Sight SeenPath::at(double time, PathPoint* point) const {
  PathPoint before;
  PathPoint after;
  Sight sight = positionAt(time - kStep, &before);
  if (sight == Sight::kSeen)
    sight = positionAt(time + kStep, &after);
  if (sight == Sight::kSeen)
    sight = positionAt(time, point);
  if (sight != Sight::kSeen)
    return sight;
  point->velocity = (after.position - before.position) / (2.0 * kStep);
  return Sight::kSeen;
}

}  // namespace wiimote_tracker::recalibrate
