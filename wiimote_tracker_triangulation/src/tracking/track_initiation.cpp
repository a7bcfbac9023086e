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

void UnassignedSpots::remove(std::size_t spot) {
  for (--count; spot < count; ++spot) {
    pixels[spot] = pixels[spot + 1];
    keys[spot] = keys[spot + 1];
  }
}

TrackInitiation::TrackInitiation(const geometry::Rig& rig,
                                 const std::vector<std::vector<std::size_t>>& partners,
                                 const TrackerOptions& options)
    : options_(options),
      partners_(partners),
      associator_(rig, partners, associationOptions(rig, options)),
      sight_cache_(rig.cameras.size()),
      sights_(rig.cameras.size()),
      spots_(rig.cameras.size()),
      views_(rig.cameras.size()) {}

void TrackInitiation::apply(const std::vector<GroupCamera>& cameras,
                            std::size_t newest,
                            std::vector<UnassignedSpots>* unassigned,
                            std::vector<Track>* tracks,
                            Ids* ids) {
  starts_.clear();
  if (!collectViews(cameras, newest, *unassigned))
    return;
  const double time = (*unassigned)[newest].time;
  const association::Association& found = associator_.associate(views_);
  used_.clear();
  for (const association::AssociatedPoint& point : found.points) {
    const auto* first = found.spots.data() + point.first_spot;
    const auto* last = first + point.spot_count;
    if (std::none_of(first, last, [&](auto& spot) { return spot.view == newest; }) ||
        !isAllowed(point) || mayShowInAnother(point, first, cameras, *unassigned))
      continue;
    initial_spots_.clear();
    for (const auto* spot = first; spot != last; ++spot) {
      const UnassignedSpots& image = (*unassigned)[spot->view];
      used_.push_back({spot->view, spots_[spot->view][spot->spot]});
      initial_spots_.push_back(image.keys[used_.back().spot]);
    }
    const std::uint32_t id = ids->idFor(initial_spots_, time, [&](std::uint32_t candidate) {
      return std::any_of(tracks->begin(), tracks->end(),
                         [&](const Track& track) { return track.id == candidate; });
    });
    tracks->emplace_back(filterOf(point, first, cameras, *unassigned), id);
    for (const auto* spot = first; spot != last; ++spot) {
      const UnassignedSpots& image = (*unassigned)[spot->view];
      tracks->back().addInitialSpot(spot->view, image.time, point.point.reprojection_error);
      starts_.push_back({spot->view, image.keys[spots_[spot->view][spot->spot]].spot, id});
    }
  }
  // In descending order, so that the remaining indices stay valid.
  std::sort(used_.begin(), used_.end(), [](auto& a, auto& b) { return a.spot > b.spot; });
  for (const association::SpotReference& spot : used_)
    (*unassigned)[spot.view].remove(spot.spot);
}

/// Takes each spot at the time of its own image. Where the LED was before, and how fast, is hardly
/// known: the images are not of one time, so the point serves to linearise only.
motion::MotionFilter TrackInitiation::filterOf(const association::AssociatedPoint& point,
                                               const association::SpotReference* spots,
                                               const std::vector<GroupCamera>& cameras,
                                               const std::vector<UnassignedSpots>& unassigned) {
  constexpr double kVague = 100.0;  // times the point's covariance
  by_time_.assign(spots, spots + point.spot_count);
  std::sort(by_time_.begin(), by_time_.end(),
            [&](auto& a, auto& b) { return unassigned[a.view].time < unassigned[b.view].time; });
  motion::MotionFilter filter(options_.motion, unassigned[by_time_.front().view].time,
                              point.point.position, kVague * point.point.covariance);
  for (const association::SpotReference& spot : by_time_) {
    const UnassignedSpots& image = unassigned[spot.view];
    const GroupCamera& camera = cameras[spot.view];
    filter.predict(image.time);
    const auto prediction = filter.predictPixel(camera.forRays(), camera.noise(image.stamp_stddev));
    if (prediction)
      filter.update(camera.forRays(), *prediction, image.pixels[spots_[spot.view][spot.spot]]);
  }
  return filter;
}

/// Not eligible is a track that has been seen beside the new one or by more cameras since; one that
/// a MergedPair is about to decide; or one of a blinking LED that may be dark. The LED may have
/// moved as no mode describes, as when it is caught, or its track may have followed a false
/// detection: initial_speed allows for that.
Track* TrackInitiation::formerTrackOf(const Track& found,
                                      const std::vector<MergedPair>& pairs,
                                      std::vector<Track>* tracks) const {
  const double time = found.filter.time();
  const double since = found.startedAt();
  Track* result = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (Track& track : *tracks) {
    const auto decidesIt = [&](const MergedPair& pair) {
      return pair.areSeparate(time) && pair.has(track.id);
    };
    if (&track == &found || !track.isConfirmed() ||
        time - track.lastObserved() < options_.dark_time ||
        track.camerasShowing(since) > found.camerasShowing(since) ||
        track.isShownBeside(found, -std::numeric_limits<double>::infinity()) ||
        std::any_of(pairs.begin(), pairs.end(), decidesIt))
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
bool TrackInitiation::collectViews(const std::vector<GroupCamera>& cameras,
                                   std::size_t newest,
                                   const std::vector<UnassignedSpots>& unassigned) {
  const double time = unassigned[newest].time;
  const auto isRecent = [&](std::size_t camera) {
    return unassigned[camera].time >= time - options_.birth_window;
  };
  const auto hasSome = [&](std::size_t camera) {
    return isRecent(camera) && unassigned[camera].count > 0;
  };
  if (unassigned[newest].count == 0 ||
      std::none_of(partners_[newest].begin(), partners_[newest].end(), hasSome))
    return false;
  association::View nothing;
  nothing.watching = false;
  std::fill(views_.begin(), views_.end(), nothing);
  const auto collect = [&](std::size_t camera) {
    association::View& view = views_[camera];
    view.watching = isRecent(camera);
    view.full = unassigned[camera].full;
    view.sights = sights_[camera].data();
    for (std::size_t spot = 0; hasSome(camera) && spot < unassigned[camera].count; ++spot) {
      const auto& sight = sightOf(cameras[camera], camera, unassigned[camera], spot);
      if (!sight)
        continue;
      spots_[camera][view.count] = spot;
      sights_[camera][view.count++] = *sight;
    }
  };
  collect(newest);
  for (const std::size_t partner : partners_[newest])
    collect(partner);
  return true;
}

const std::optional<geometry::Sight>& TrackInitiation::sightOf(const GroupCamera& camera,
                                                               std::size_t index,
                                                               const UnassignedSpots& unassigned,
                                                               std::size_t spot) {
  const SpotKey& key = unassigned.keys[spot];
  CachedSight& known = sight_cache_[index][key.spot];
  if (known.image != key.image) {
    known.image = key.image;
    known.sight = geometry::sightFromPixel(camera.forRays(), unassigned.pixels[spot]);
  }
  return known.sight;
}

/// Whether a camera that has not looked yet may show the point too.
bool TrackInitiation::mayShowInAnother(const association::AssociatedPoint& point,
                                       const association::SpotReference* spots,
                                       const std::vector<GroupCamera>& cameras,
                                       const std::vector<UnassignedSpots>& unassigned) const {
  double since = std::numeric_limits<double>::infinity();
  for (const auto* spot = spots; spot != spots + point.spot_count; ++spot)
    since = std::min(since, unassigned[spot->view].since);
  for (std::size_t camera = 0; camera < cameras.size(); ++camera) {
    if (views_[camera].watching && unassigned[camera].time < since &&
        cameras[camera].forRays().sees(point.point.position))
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
