#include "seen_path.h"

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
    rays_.push_back(rig.rayCamera(camera));
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
  std::vector<capture::View> views;
  double largest_miss = kLargestMiss;
  for (const std::size_t i : seeing_) {
    const auto view = capture::viewAt(i, tracks_[i].spots, time);
    if (!view)
      continue;
    views.push_back(*view);
    if (!tracks_[i].clock_known)
      largest_miss = kLargestMissUnclocked;
  }
  if (views.size() < 2)
    return Sight::kNotSeen;
  const auto found = capture::locate(rays_, views, largest_miss, 2);
  if (!found)
    return Sight::kContradictory;
  if (found->point.covariance.trace() > kLargestSpread * kLargestSpread)
    return Sight::kUndetermined;
  point->position = found->point.position;
  point->unit_covariance = found->point.covariance;
  point->cameras.clear();
  for (const capture::View& view : found->views)
    point->cameras.push_back(view.camera);
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
