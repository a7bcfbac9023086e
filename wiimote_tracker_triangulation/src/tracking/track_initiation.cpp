#include "track_initiation.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>

namespace wiimote_tracker::tracking {
namespace {

/// The pixels' standard deviation includes the motion between the cameras' images.
association::AssociationOptions associationOptions(const geometry::Rig& rig,
                                                   const TrackerOptions& options) {
  association::AssociationOptions result = association::typicalCosts(
      rig, options.birth_pixel_stddev, options.ghost_rate, options.detection_probability);
  result.minimum_angle = options.minimum_angle;
  return result;
}

}  // namespace

TrackInitiation::TrackInitiation(const geometry::Rig& rig,
                                 const std::vector<std::vector<std::size_t>>& partners,
                                 const std::vector<TrackerCamera>& cameras,
                                 const TrackerOptions& options,
                                 Ids* ids)
    : cameras_(cameras),
      options_(options),
      ids_(ids),
      partners_(partners),
      associator_(rig, partners, associationOptions(rig, options)),
      views_(rig.cameras.size()) {}

void TrackInitiation::apply(std::size_t newest, GroupState* state) {
  starts_.clear();
  state_ = state;
  if (!collectViews(newest))
    return;
  const association::Association& found = associator_.associate(views_);
  used_.clear();
  for (const association::AssociatedPoint& point : found.points) {
    if (std::none_of(point.spots.begin(), point.spots.end(),
                     [&](auto& spot) { return spot.view == newest; }) ||
        !isAllowed(point) || mayShowInAnother(point))
      continue;
    start(point, unassignedOf(newest).time);
    used_.insert(used_.end(), point.spots.begin(), point.spots.end());
  }
  removeUsed();
}

/// Starts a track from the spots of a point, at the time of the newest of them.
void TrackInitiation::start(const association::AssociatedPoint& point, double time) {
  initial_spots_.clear();
  for (const association::SpotReference& spot : point.spots)
    initial_spots_.push_back(spotAt(spot).key);
  const std::uint32_t id = ids_->idFor(initial_spots_, time, [&](std::uint32_t candidate) {
    return std::any_of(state_->tracks.begin(), state_->tracks.end(),
                       [&](const Track& track) { return track.id == candidate; });
  });
  Track& track = state_->tracks.emplace_back(filterOf(point), id);
  for (const association::SpotReference& spot : point.spots) {
    track.addInitialSpot(spot.view, unassignedOf(spot.view).time, point.point.reprojection_error);
    starts_.push_back({spot.view, spotAt(spot).key.spot, id});
  }
}

/// In descending order, so that the remaining indices stay valid.
void TrackInitiation::removeUsed() {
  std::sort(used_.begin(), used_.end(), [](auto& a, auto& b) { return a.spot > b.spot; });
  for (const association::SpotReference& spot : used_) {
    UnassignedSpots& rest = unassignedOf(spot.view);
    rest.spots.erase(rest.spots.begin() + spot.spot);
    rest.sights.erase(rest.sights.begin() + spot.spot);
  }
}

/// Takes each spot at the time of its own image. Where the LED was before, and how fast, is hardly
/// known: the images are not of one time, so the point serves to linearise only.
motion::MotionFilter TrackInitiation::filterOf(const association::AssociatedPoint& point) const {
  constexpr double kVague = 100.0;  // times the point's covariance
  association::SpotReferences by_time = point.spots;
  std::sort(by_time.begin(), by_time.end(), [&](auto& a, auto& b) {
    return unassignedOf(a.view).time < unassignedOf(b.view).time;
  });
  motion::MotionFilter filter(options_.motion, unassignedOf(by_time.front().view).time,
                              point.point.position, kVague * point.point.covariance);
  for (const association::SpotReference& spot : by_time) {
    const UnassignedSpots& image = unassignedOf(spot.view);
    const TrackerCamera& camera = cameras_[spot.view];
    filter.predict(image.time);
    const auto prediction = filter.predictPixel(camera.forRays(), camera.noise(image.stamp_stddev));
    if (prediction)
      filter.update(camera.forRays(), *prediction, spotAt(spot).pixel);
  }
  return filter;
}

/// Not eligible is a track that has been seen beside the new one or by more cameras since; one that
/// a MergedPair is about to decide; or one of a blinking LED that may be dark. The LED may have
/// moved as no mode describes, as when it is caught, or its track may have followed a false
/// detection: initial_speed allows for that.
Track* TrackInitiation::formerTrackOf(const Track& found, GroupState* state) const {
  const double time = found.filter.time();
  const double since = found.startedAt();
  Track* result = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (Track& track : state->tracks) {
    const auto decidesIt = [&](const MergedPair& pair) {
      return pair.areSeparate(time) && pair.has(track.id);
    };
    if (&track == &found || !track.isConfirmed() ||
        time - track.lastObserved() < options_.dark_time ||
        track.camerasShowing(since) > found.camerasShowing(since) ||
        track.isShownBeside(found, -std::numeric_limits<double>::infinity()) ||
        std::any_of(state->pairs.begin(), state->pairs.end(), decidesIt))
      continue;
    motion::MotionFilter expected = track.filter;
    expected.predict(time);
    const double slack = options_.motion.initial_speed * (time - track.lastObserved());
    const Eigen::Matrix3d covariance = expected.positionCovariance() +
                                       found.filter.positionCovariance() +
                                       slack * slack * Eigen::Matrix3d::Identity();
    const Eigen::Vector3d offset = found.filter.position() - expected.position();
    const double distance = offset.dot(covariance.inverse() * offset);
    const double cost = distance + std::log(covariance.determinant());  // -2 log likelihood
    if (distance <= options_.gate && cost < least) {
      least = cost;
      result = &track;
    }
  }
  return result;
}

/// Fills views_ with the recent unassigned spots. False when no two cameras have any.
bool TrackInitiation::collectViews(std::size_t newest) {
  const double since = unassignedOf(newest).time - options_.birth_window;
  const auto viewOf = [&](std::size_t camera) -> association::View {
    const UnassignedSpots& rest = unassignedOf(camera);
    const bool is_recent = rest.time >= since;
    return {rest.sights.data(), is_recent ? rest.sights.size() : 0, is_recent, rest.full};
  };
  const std::vector<std::size_t>& partners = partners_[newest];
  if (viewOf(newest).count == 0 ||
      std::none_of(partners.begin(), partners.end(),
                   [&](std::size_t partner) { return viewOf(partner).count > 0; }))
    return false;
  association::View nothing;
  nothing.watching = false;
  std::fill(views_.begin(), views_.end(), nothing);
  views_[newest] = viewOf(newest);
  for (const std::size_t partner : partners)
    views_[partner] = viewOf(partner);
  return true;
}

/// Whether a camera that has not looked yet may show the point too.
bool TrackInitiation::mayShowInAnother(const association::AssociatedPoint& point) const {
  double since = std::numeric_limits<double>::infinity();
  for (const association::SpotReference& spot : point.spots)
    since = std::min(since, unassignedOf(spot.view).since);
  for (std::size_t camera = 0; camera < cameras_.size(); ++camera) {
    if (views_[camera].watching && unassignedOf(camera).time < since &&
        cameras_[camera].forRays().sees(point.point.position))
      return true;
  }
  return false;
}

bool TrackInitiation::isAllowed(const association::AssociatedPoint& point) const {
  const Eigen::Vector3d& place = point.point.position;
  return place.allFinite() && point.point.covariance.allFinite() &&
         (place.array() >= options_.minimum_corner.array()).all() &&
         (place.array() <= options_.maximum_corner.array()).all();
}

}  // namespace wiimote_tracker::tracking
