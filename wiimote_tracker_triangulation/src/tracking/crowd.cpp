#include "crowd.h"

#include <Eigen/LU>

#include <algorithm>

namespace wiimote_tracker::tracking {
namespace {

bool isShownBy(std::size_t camera, const TrackedLed& led) {
  return std::binary_search(led.cameras.begin(), led.cameras.end(), camera);
}

bool isOfConfirmedLed(const SeenSpot& spot, const std::vector<Track>& tracks) {
  return spot.use == SpotUse::kAssigned &&
         std::any_of(tracks.begin(), tracks.end(), [&](const Track& track) {
           return track.id == spot.led && track.isConfirmed();
         });
}

}  // namespace

bool Crowd::isFull(std::size_t member) const {
  constexpr double kOldest = 0.2;  // more than between two images, if some are lost [s]
  const CameraView& view = viewOf(member);
  return view.full && view.time && *view.time >= time_ - kOldest;
}

/// No spot of it now, nor within tracked_time: a false detection hides an LED in one image only.
bool Crowd::isHiddenIn(std::size_t member, const TrackedLed& led) const {
  const auto& spots = viewOf(member).spots;
  return !isShownBy(members_[member], led) &&
         std::none_of(spots.begin(), spots.end(), [&](const SeenSpot& spot) {
           return spot.use == SpotUse::kAssigned && spot.led == led.id;
         });
}

bool Crowd::hasUnknownLight(std::size_t member) const {
  const auto& spots = viewOf(member).spots;
  return std::any_of(spots.begin(), spots.end(), [&](const SeenSpot& spot) {
    return spot.use != SpotUse::kMasked && !isOfConfirmedLed(spot, tracks_);
  });
}

bool Crowd::mayHideLedsNear(const TrackedLed& led) const {
  std::size_t cameras = 0;
  bool is_crowded_out = false;
  for (std::size_t i = 0; i < members_.size(); ++i) {
    if (!isFull(i))
      continue;
    const bool is_hidden = isHiddenIn(i, led);
    const bool has_unknown = hasUnknownLight(i);
    if (!(is_hidden || has_unknown) || !cameras_[i].forRays().sees(led.position))
      continue;
    ++cameras;
    is_crowded_out = is_crowded_out || (is_hidden && has_unknown);
  }
  return cameras >= 2 && is_crowded_out;
}

Eigen::Matrix3d Crowd::mergingCovariance(const TrackedLed& led) const {
  constexpr double kSingular = 1e-10;
  if (!mayHideLedsNear(led))
    return Eigen::Matrix3d::Zero();
  const double stddev = 0.25 * options_.merging_distance;  // of a coordinate in the circle [px]
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < members_.size(); ++i) {
    Eigen::Matrix<double, 2, 3> jacobian;
    if (isShownBy(members_[i], led) && cameras_[i].forRays().project(led.position, &jacobian))
      information.noalias() += jacobian.transpose() * jacobian;
  }
  const double trace = information.trace();
  if (!(information.determinant() > kSingular * trace * trace * trace))  // one camera, or none
    return Eigen::Matrix3d::Zero();
  return stddev * stddev * information.inverse();
}

}  // namespace wiimote_tracker::tracking
