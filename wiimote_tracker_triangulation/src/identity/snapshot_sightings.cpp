#include "wiimote_tracker_triangulation/identity/snapshot_sightings.h"

namespace wiimote_tracker::identity {

using tracking::CameraView;
using tracking::Snapshot;
using tracking::TrackedLed;
using tracking::TrackState;

void SnapshotSightings::expectPixels(const geometry::Camera& camera, const Snapshot& snapshot) {
  pixels_.clear();
  for (const TrackedLed& led : snapshot.leds)
    pixels_.push_back(camera.project(led.position));
}

/// Whether the spot may belong to another LED that is tracked or predicted.
bool SnapshotSightings::mayBeOtherLed(const Eigen::Vector2d& pixel,
                                      const Snapshot& snapshot,
                                      std::size_t led) const {
  const double distance = options_.merging_distance;
  for (std::size_t other = 0; other < pixels_.size(); ++other) {
    const TrackState state = snapshot.leds[other].state;
    if (other != led && pixels_[other] &&
        (state == TrackState::kTracked || state == TrackState::kPredicted) &&
        (pixel - *pixels_[other]).squaredNorm() < distance * distance)
      return true;
  }
  return false;
}

// Nothing: the image need not show the LED, or may show another one in its place.
std::optional<bool> SnapshotSightings::isSeen(const geometry::RigCamera& camera,
                                              const CameraView& view,
                                              const Snapshot& snapshot,
                                              std::size_t led) const {
  for (const tracking::SeenSpot& spot : view.spots) {
    if (spot.use != tracking::SpotUse::kAssigned || spot.led != snapshot.leds[led].id)
      continue;
    if (mayBeOtherLed(spot.pixel, snapshot, led))
      return std::nullopt;
    return true;
  }
  if (view.full)
    return std::nullopt;
  const std::optional<Eigen::Vector2d>& pixel = pixels_[led];
  const double border = options_.merging_distance;
  if (!pixel || !camera.camera.intrinsics.isInImage(*pixel, -border) ||
      geometry::isMasked(camera.masks, *pixel))
    return std::nullopt;
  for (const tracking::SeenSpot& spot : view.spots) {
    if ((spot.pixel - *pixel).squaredNorm() < border * border)
      return std::nullopt;
  }
  return false;
}

const std::vector<TrackSighting>& SnapshotSightings::collect(const geometry::Rig& rig,
                                                             const Snapshot& snapshot) {
  sightings_.clear();
  times_.resize(snapshot.views.size());
  for (std::size_t camera = 0; camera < snapshot.views.size(); ++camera) {
    const CameraView& view = snapshot.views[camera];
    if (!view.time || view.time == times_[camera])
      continue;
    times_[camera] = view.time;
    // Rig::rayCamera() copies the camera's name, which may allocate.
    if (rig.ray_model == geometry::RayModel::kCalibrated)
      expectPixels(rig.cameras[camera].camera, snapshot);
    else
      expectPixels(rig.rayCamera(rig.cameras[camera]), snapshot);
    for (std::size_t led = 0; led < snapshot.leds.size(); ++led) {
      if (snapshot.leds[led].state == TrackState::kLost)
        continue;
      const std::optional<bool> seen = isSeen(rig.cameras[camera], view, snapshot, led);
      if (seen)
        sightings_.push_back(
            {snapshot.leds[led].id, {camera, *view.time, options_.exposure, *seen}});
    }
  }
  return sightings_;
}

void SnapshotSightings::add(const geometry::Rig& rig,
                            const Snapshot& snapshot,
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
