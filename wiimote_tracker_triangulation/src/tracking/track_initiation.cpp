#include "track_initiation.h"

#include <algorithm>
#include <limits>

namespace wiimote_tracker::tracking {
namespace {

const UnassignedSpots& imageOf(const association::SpotReference& spot,
                               const CameraStates& cameras) {
  return cameras.at(spot.view).unassigned;
}

/// The pixels' standard deviation includes the motion between the cameras' images.
association::AssociationOptions associationOptions(const geometry::Rig& rig,
                                                   const TrackerOptions& options) {
  association::AssociationOptions result = association::typicalCosts(
      rig, options.birth_pixel_stddev, options.ghost_rate, options.detection_probability);
  result.minimum_angle = options.minimum_angle;
  return result;
}

bool isAllowed(const association::AssociatedPoint& point, const TrackerOptions& options) {
  const Eigen::Vector3d& place = point.point.position;
  return place.allFinite() && point.point.covariance.allFinite() &&
         (place.array() >= options.minimum_corner.array()).all() &&
         (place.array() <= options.maximum_corner.array()).all();
}

/// Takes each spot at the time of its own image. Where the LED was before, and how fast, is hardly
/// known: the images are not of one time, so the point serves to linearise only.
motion::MotionFilter filterOf(const association::AssociatedPoint& point,
                              const CameraStates& states,
                              const GroupSetup& setup) {
  constexpr double kVague = 100.0;  // times the point's covariance
  association::SpotReferences by_time = point.spots;
  std::sort(by_time.begin(), by_time.end(),
            [&](auto& a, auto& b) { return imageOf(a, states).time < imageOf(b, states).time; });
  motion::MotionFilter filter(setup.options.motion, imageOf(by_time.front(), states).time,
                              point.point.position, kVague * point.point.covariance);
  for (const association::SpotReference& spot : by_time) {
    const UnassignedSpots& image = imageOf(spot, states);
    const TrackerCamera& camera = setup.cameras[spot.view];
    filter.predict(image.time);
    const auto prediction = filter.predictPixel(camera.forRays(), camera.noise(image.stamp_stddev));
    if (prediction)
      filter.update(camera.forRays(), *prediction, image.spots[spot.spot].pixel);
  }
  return filter;
}

void removeSpot(const StartSpot& used, CameraStates* cameras) {
  UnassignedSpots& rest = cameras->at(used.camera).unassigned;
  const auto spot = std::find_if(rest.spots.begin(), rest.spots.end(),
                                 [&](auto& known) { return known.key.spot == used.spot; });
  rest.sights.erase(rest.sights.begin() + (spot - rest.spots.begin()));
  rest.spots.erase(spot);
}

}  // namespace

TrackInitiation::TrackInitiation(const GroupSetup& setup,
                                 const std::vector<std::vector<std::size_t>>& partners,
                                 Ids* ids)
    : setup_(setup),
      ids_(ids),
      partners_(partners),
      associator_(setup.rig, partners, associationOptions(setup.rig, setup.options)),
      views_(setup.cameras.size()) {}

const std::vector<StartSpot>& TrackInitiation::apply(std::size_t newest, GroupState* state) {
  starts_.clear();
  if (!collectViews(newest, state->cameras))
    return starts_;
  const double time = state->cameras.at(newest).unassigned.time;
  for (const association::AssociatedPoint& point : associator_.associate(views_).points) {
    if (std::any_of(point.spots.begin(), point.spots.end(),
                    [&](auto& spot) { return spot.view == newest; }) &&
        isAllowed(point, setup_.options) && !mayShowInAnother(point, state->cameras))
      start(point, time, state);
  }
  for (const StartSpot& used : starts_)
    removeSpot(used, &state->cameras);
  return starts_;
}

/// Starts a track from the spots of a point, at the time of the newest of them.
void TrackInitiation::start(const association::AssociatedPoint& point,
                            double time,
                            GroupState* state) {
  const auto keyOf = [&](const association::SpotReference& spot) {
    return imageOf(spot, state->cameras).spots[spot.spot].key;
  };
  initial_spots_.clear();
  for (const association::SpotReference& spot : point.spots)
    initial_spots_.push_back(keyOf(spot));
  const std::uint32_t id = ids_->idFor(initial_spots_, time, [&](std::uint32_t candidate) {
    return std::any_of(state->tracks.begin(), state->tracks.end(),
                       [&](const Track& track) { return track.id() == candidate; });
  });
  Track& track = state->tracks.emplace_back(filterOf(point, state->cameras, setup_), id);
  for (const association::SpotReference& spot : point.spots) {
    track.addInitialSpot(spot.view, imageOf(spot, state->cameras).time,
                         point.point.reprojection_error);
    starts_.push_back({spot.view, keyOf(spot).spot, id});
  }
}

/// Fills views_ with the recent unassigned spots. False when no two cameras have any.
bool TrackInitiation::collectViews(std::size_t newest, const CameraStates& cameras) {
  const double since = cameras.at(newest).unassigned.time - setup_.options.birth_window;
  const auto viewOf = [&](std::size_t camera) -> association::View {
    const UnassignedSpots& rest = cameras.at(camera).unassigned;
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
bool TrackInitiation::mayShowInAnother(const association::AssociatedPoint& point,
                                       const CameraStates& cameras) const {
  double since = std::numeric_limits<double>::infinity();
  for (const association::SpotReference& spot : point.spots)
    since = std::min(since, imageOf(spot, cameras).since);
  for (std::size_t camera = 0; camera < setup_.cameras.size(); ++camera) {
    if (views_[camera].watching && cameras.at(camera).unassigned.time < since &&
        setup_.cameras[camera].forRays().sees(point.point.position))
      return true;
  }
  return false;
}

}  // namespace wiimote_tracker::tracking
