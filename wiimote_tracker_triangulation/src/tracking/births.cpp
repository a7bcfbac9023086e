#include "births.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>

namespace wiimote_tracker::tracking {
namespace {

/// In the terms of AssociationOptions, for pixels as uncertain as motion makes them.
association::AssociationOptions associationOptions(const TrackerOptions& options) {
  association::AssociationOptions result = association::typicalCosts(
      options.birth_pixel_stddev, options.ghost_rate, options.detection_probability);
  result.minimum_angle = options.minimum_angle;
  return result;
}

}  // namespace

void Unexplained::remove(std::size_t spot) {
  for (--count; spot < count; ++spot) {
    pixels[spot] = pixels[spot + 1];
    keys[spot] = keys[spot + 1];
  }
}

Births::Births(const geometry::Rig& rig,
               const std::vector<std::vector<std::size_t>>& partners,
               const TrackerOptions& options)
    : options_(options),
      motion_(&options.motion),
      partners_(partners),
      associator_(rig, partners, associationOptions(options)),
      known_(rig.cameras.size()),
      sights_(rig.cameras.size()),
      spots_(rig.cameras.size()),
      views_(rig.cameras.size()) {}

void Births::find(const std::vector<GroupCamera>& cameras,
                  std::size_t newest,
                  const std::vector<Encounter>& encounters,
                  std::vector<Unexplained>* unexplained,
                  std::vector<Track>* tracks,
                  Ids* ids) {
  if (!collectViews(cameras, newest, *unexplained))
    return;
  const double time = (*unexplained)[newest].time;
  const association::Association& found = associator_.associate(views_);
  used_.clear();
  for (const association::AssociatedPoint& point : found.points) {
    const auto* first = found.spots.data() + point.first_spot;
    const auto* last = first + point.spot_count;
    if (std::none_of(first, last, [&](auto& spot) { return spot.view == newest; }) ||
        !isWelcome(point))
      continue;
    founders_.clear();
    founding_images_.clear();
    for (const auto* spot = first; spot != last; ++spot) {
      const Unexplained& image = (*unexplained)[spot->view];
      used_.push_back({spot->view, spots_[spot->view][spot->spot]});
      founders_.push_back(image.keys[used_.back().spot]);
      founding_images_.push_back({spot->view, image.time});
    }
    Track* track =
        trackOf(motion::MotionFilter(*motion_, time, point.point.position, point.point.covariance),
                encounters, tracks, ids);
    for (const auto* spot = first; spot != last; ++spot)
      track->foundBy(spot->view, point.point.reprojection_error);
  }
  // From the back, so that the places of the others stay.
  std::sort(used_.begin(), used_.end(), [](auto& a, auto& b) { return a.spot > b.spot; });
  for (const association::SpotReference& spot : used_)
    (*unexplained)[spot.view].remove(spot.spot);
}

/// One that is found again, or a new one.
Track* Births::trackOf(const motion::MotionFilter& start,
                       const std::vector<Encounter>& encounters,
                       std::vector<Track>* tracks,
                       Ids* ids) const {
  if (Track* missed = missedAt(start, encounters, tracks)) {
    missed->restart(start);
    return missed;
  }
  const std::uint32_t id = ids->idFor(founders_, start.time(), [&](std::uint32_t candidate) {
    return std::any_of(tracks->begin(), tracks->end(),
                       [&](const Track& track) { return track.id == candidate; });
  });
  tracks->emplace_back(start, id);
  return &tracks->back();
}

/// The likeliest of the LEDs that may be there and that the founding images do not show elsewhere,
/// nor more others since. Its motion may have been another than all that were reckoned with, as
/// when it is caught, or when a spot was not its: initial_speed allows for that. Which of two that
/// have been one spot it is, their motion is about to tell. One that blinks is not missed while it
/// may be dark: when it lights up, its motion tells where, better than the first two rays do.
Track* Births::missedAt(const motion::MotionFilter& found,
                        const std::vector<Encounter>& encounters,
                        std::vector<Track>* tracks) const {
  double since = found.time();
  for (const FoundingImage& image : founding_images_)
    since = std::min(since, image.time);
  Track* result = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (Track& track : *tracks) {
    const auto showsIt = [&](const FoundingImage& image) {
      return track.isShownBy(image.camera, image.time);
    };
    const auto holdsIt = [&](const Encounter& encounter) {
      return encounter.areApart(found.time()) &&
             (encounter.ids()[0] == track.id || encounter.ids()[1] == track.id);
    };
    const bool may_be_dark = found.time() - track.lastObserved() < options_.dark_time;
    if (!track.isConfirmed() || may_be_dark || track.showers(since) > founding_images_.size() ||
        std::any_of(founding_images_.begin(), founding_images_.end(), showsIt) ||
        std::any_of(encounters.begin(), encounters.end(), holdsIt))
      continue;
    motion::MotionFilter expected = track.filter;
    expected.predict(found.time());
    const double slack = motion_->initial_speed * (found.time() - track.lastObserved());
    const Eigen::Matrix3d covariance = expected.positionCovariance() + found.positionCovariance() +
                                       slack * slack * Eigen::Matrix3d::Identity();
    const Eigen::Vector3d offset = found.position() - expected.position();
    const double distance = offset.dot(covariance.inverse() * offset);
    const double cost = distance + std::log(covariance.determinant());  // -2 log likelihood
    if (distance <= options_.gate && cost < least) {
      least = cost;
      result = &track;
    }
  }
  return result;
}

/// False when nothing can meet.
bool Births::collectViews(const std::vector<GroupCamera>& cameras,
                          std::size_t newest,
                          const std::vector<Unexplained>& unexplained) {
  const double time = unexplained[newest].time;
  const auto isRecent = [&](std::size_t camera) {
    return unexplained[camera].time >= time - options_.birth_window;
  };
  const auto hasSome = [&](std::size_t camera) {
    return isRecent(camera) && unexplained[camera].count > 0;
  };
  if (unexplained[newest].count == 0 ||
      std::none_of(partners_[newest].begin(), partners_[newest].end(), hasSome))
    return false;
  std::fill(views_.begin(), views_.end(), association::View());
  const auto collect = [&](std::size_t camera) {
    association::View& view = views_[camera];
    view.watching = isRecent(camera);
    view.full = unexplained[camera].full;
    view.sights = sights_[camera].data();
    for (std::size_t spot = 0; hasSome(camera) && spot < unexplained[camera].count; ++spot) {
      const auto& sight = sightOf(cameras[camera], camera, unexplained[camera], spot);
      if (!sight)
        continue;
      spots_[camera][view.count] = spot;
      sights_[camera][view.count++] = *sight;
    }
  };
  for (association::View& view : views_)
    view.watching = false;
  collect(newest);
  for (const std::size_t partner : partners_[newest])
    collect(partner);
  return true;
}

/// A spot without a partner is looked at again with every camera's next image.
const std::optional<geometry::Sight>& Births::sightOf(const GroupCamera& camera,
                                                      std::size_t index,
                                                      const Unexplained& unexplained,
                                                      std::size_t spot) {
  const SpotKey& key = unexplained.keys[spot];
  KnownSight& known = known_[index][key.spot];
  if (known.image != key.image) {
    known.image = key.image;
    known.sight = geometry::sightFromPixel(camera.forRays(), unexplained.pixels[spot]);
  }
  return known.sight;
}

bool Births::isWelcome(const association::AssociatedPoint& point) const {
  const Eigen::Vector3d& place = point.point.position;
  return place.allFinite() && point.point.covariance.allFinite() &&
         (place.array() >= options_.minimum_corner.array()).all() &&
         (place.array() <= options_.maximum_corner.array()).all();
}

}  // namespace wiimote_tracker::tracking
