#include "crowd.h"

#include "group_state.h"

#include <Eigen/LU>

#include <algorithm>

namespace wiimote_tracker::tracking {
namespace {

/// Whether there may be a crowd about a track's LED: a full camera shows an unknown light instead
/// of the LED in its view, and another one shows an unknown light or not the LED. What one camera
/// alone shows may be a lamp, or the camera was moved.
bool isInCrowd(const Track& track,
               const CameraStates& states,
               const GroupSetup& setup,
               double time) {
  constexpr double kOldest = 0.2;  // more than between two images, if some are lost [s]
  const Eigen::Vector3d position = track.approximatePosition(time);
  std::size_t count = 0;
  bool is_crowded_out = false;
  for (const auto& [camera, state] : states) {
    const NewestImage& view = state.newest;
    if (!view.full || view.time < time - kOldest)
      continue;
    // No spot of it now, nor within tracked_time: a false detection hides an LED in one image only.
    const bool is_hidden = track.cameras().lastDetectedBy(camera) <
                           std::min(view.time, time - setup.options.tracked_time);
    if (!(is_hidden || view.has_unknown) || !setup.cameras[camera].forRays().sees(position))
      continue;
    ++count;
    is_crowded_out = is_crowded_out || (is_hidden && view.has_unknown);
  }
  return count >= 2 && is_crowded_out;
}

}  // namespace

bool noteCrowds(const StoredImage& image,
                const association::TrackOfSpot& track_of_spot,
                const GroupSetup& setup,
                GroupState* state) {
  const auto begin = track_of_spot.begin();
  const bool has_unknown = std::any_of(begin, begin + image.spot_count, [&](int track) {
    return track == association::kFalseDetection || !state->tracks[track].isConfirmed();
  });
  state->cameras.at(image.camera).newest = {image.time, image.full, has_unknown};
  bool in_crowd = false;
  for (Track& track : state->tracks) {
    if (!track.isConfirmed())
      continue;
    if (isInCrowd(track, state->cameras, setup, image.time))
      track.crowd().note(image.time);
    in_crowd = in_crowd || track.crowd().isCrowded(image.time);
  }
  return in_crowd;
}

Eigen::Matrix3d mergingCovariance(const TrackedLed& led,
                                  const std::vector<TrackerCamera>& cameras,
                                  double merging_distance) {
  constexpr double kSingular = 1e-10;
  const double stddev = 0.25 * merging_distance;  // of a coordinate in the circle [px]
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  for (const std::size_t camera : led.cameras) {
    Eigen::Matrix<double, 2, 3> jacobian;
    if (cameras[camera].forRays().project(led.position, &jacobian))
      information.noalias() += jacobian.transpose() * jacobian;
  }
  const double trace = information.trace();
  if (!(information.determinant() > kSingular * trace * trace * trace))  // one camera, or none
    return Eigen::Matrix3d::Zero();
  return stddev * stddev * information.inverse();
}

}  // namespace wiimote_tracker::tracking
