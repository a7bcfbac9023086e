#include "wiimote_tracker_triangulation/identity/snapshot_sightings.h"

#include "wiimote_tracker_triangulation/geometry/image_rules.h"

namespace wiimote_tracker::identity {

using tracking::CameraView;
using tracking::TrackedLed;
using tracking::TrackState;

// Nothing: the image need not show the LED.
std::optional<bool> SnapshotSightings::isSeen(const geometry::RigCamera& camera,
                                              const CameraView& view,
                                              const TrackedLed& led) const {
  for (const tracking::SeenSpot& spot : view.spots) {
    if (spot.use == tracking::SpotUse::kAssigned && spot.led == led.id)
      return true;
  }
  if (view.spots.size() >= options_.maximum_spots)
    return std::nullopt;
  const std::optional<Eigen::Vector2d> pixel = camera.camera.project(led.position);
  const geometry::Intrinsics& image = camera.camera.intrinsics;
  const double border = options_.merging_distance;
  if (!pixel || pixel->x() < border || pixel->x() > image.width - 1 - border ||
      pixel->y() < border || pixel->y() > image.height - 1 - border ||
      geometry::isMasked(camera, *pixel))
    return std::nullopt;
  for (const tracking::SeenSpot& spot : view.spots) {
    if ((spot.pixel - *pixel).squaredNorm() < border * border)
      return std::nullopt;
  }
  return false;
}

const std::vector<TrackSighting>& SnapshotSightings::collect(const geometry::Rig& rig,
                                                             const tracking::Snapshot& snapshot) {
  sightings_.clear();
  times_.resize(snapshot.views.size());
  for (std::size_t camera = 0; camera < snapshot.views.size(); ++camera) {
    const CameraView& view = snapshot.views[camera];
    if (!view.time || view.time == times_[camera])
      continue;
    times_[camera] = view.time;
    for (const TrackedLed& led : snapshot.leds) {
      if (led.state == TrackState::kLost)
        continue;
      const std::optional<bool> seen = isSeen(rig.cameras[camera], view, led);
      if (seen)
        sightings_.push_back({led.id, {camera, *view.time, options_.exposure, *seen}});
    }
  }
  return sightings_;
}

void SnapshotSightings::add(const geometry::Rig& rig,
                            const tracking::Snapshot& snapshot,
                            Identifier* identifier) {
  for (const TrackSighting& s : collect(rig, snapshot))
    identifier->add(s.led, s.sighting);
  for (const TrackedLed& led : snapshot.leds) {
    if (led.state == TrackState::kLost)
      identifier->forget(led.id);
  }
  identifier->decide(snapshot.time);
}

}  // namespace wiimote_tracker::identity
