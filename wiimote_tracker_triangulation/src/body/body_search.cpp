#include "body/body_search.h"

#include <algorithm>
#include <cmath>

namespace wiimote_tracker::body {
namespace {

/// LEDs move within the window, so rays miss each other by this multiple of the pixel noise.
constexpr double kWindowNoise = 4.0;

association::AssociationOptions associationOptions(const BodyTrackerOptions& options) {
  association::AssociationOptions result;
  result.pixel_stddev = kWindowNoise * options.pixel_stddev;
  return result;
}

}  // namespace

BodySearch::BodySearch(const BodySetup& setup, BodyState* state, BodyUpdate* update)
    : setup_(setup),
      state_(*state),
      update_(*update),
      associator_(setup.rig, setup.partners, associationOptions(setup.options)),
      candidates_(setup.cameras.size()),
      sights_(setup.cameras.size()),
      views_(setup.cameras.size()) {}

/// Bodies that are tracked come first, so that no other body gets their LEDs.
void BodySearch::find(const BodyImage& image) {
  const double time = image.time;
  needed_spots_.clear();
  for (std::size_t b = 0; b < state_.bodies.size(); ++b)
    needed_spots_.push_back(neededSpots(b, time));
  if (std::none_of(needed_spots_.begin(), needed_spots_.end(),
                   [](const auto& needed) { return needed.has_value(); }))
    return;
  const association::Association& found = locateSpots(time);
  for (const bool tracked : {true, false}) {
    for (std::size_t b = 0; b < state_.bodies.size(); ++b) {
      if (!needed_spots_[b] || isTracked(b, time) != tracked)
        continue;
      const Constellation& constellation = setup_.bodies[b].constellation;
      const std::optional<Match> match = matchPoints(constellation, points_);
      if (!match || match->margin < setup_.options.minimum_margin)
        continue;
      listMatchedSpots(b, *match, found);
      const bool is_where_predicted =
          state_.bodies[b] && isSamePose(constellation.leds, match->world_from_body,
                                         state_.bodies[b]->filter.state().worldFromBody());
      const bool goes_on =
          is_where_predicted && (update_.followMatch(b, matched_spots_, image) || tracked);
      if (!goes_on && !start(b, *match, time))
        continue;
      for (const int p : match->point_of_led) {
        if (p != kUnseen)
          points_[p].taken = true;
      }
    }
  }
}

/// Spots that a match needs for a body to be started there. A hidden body may reappear anywhere. A
/// body that was started with LEDs exchanged stays tracked by the spots that fit by chance: its
/// right pose explains more. Nothing: the body cannot be started.
std::optional<std::size_t> BodySearch::neededSpots(std::size_t body, double time) const {
  if (!setup_.bodies[body].has_clear_shape)
    return std::nullopt;
  if (!isTracked(body, time))
    return 0;
  const std::size_t needed = countSpots(body, time) + 1;
  std::size_t most = 0;  // that any pose explains
  for (const LastImage& image : state_.images) {
    if (time - image.time <= setup_.options.window)
      most += std::min(setup_.bodies[body].constellation.leds.size(),
                       image.free.size() + image.countSpots(body));
  }
  return needed <= most ? std::make_optional(needed) : std::nullopt;
}

bool BodySearch::isTracked(std::size_t body, double time) const {
  return state_.bodies[body] &&
         time - state_.bodies[body]->last_observed <= setup_.options.tracked_time;
}

/// Spots of the images in the window that the pose of a body explains, or did when it was found.
std::size_t BodySearch::countSpots(std::size_t body, double time) const {
  std::size_t spots = 0;
  for (const LastImage& image : state_.images) {
    if (time - image.time <= setup_.options.window)
      spots += image.countSpots(body);
  }
  const KnownBody& known = *state_.bodies[body];
  return time - known.found_time <= setup_.options.window ? std::max(spots, known.found_spots)
                                                          : spots;
}

/// Of the newest images: the spots without a body, and those of bodies that may be elsewhere.
const association::Association& BodySearch::locateSpots(double time) {
  for (std::size_t c = 0; c < setup_.cameras.size(); ++c) {
    const LastImage& image = state_.images[c];
    candidates_[c].clear();
    sights_[c].clear();
    const auto add = [&](const Eigen::Vector2d& pixel) {
      if (const auto sight = geometry::sightFromPixel(setup_.cameras[c], pixel)) {
        candidates_[c].push_back(pixel);
        sights_[c].push_back(*sight);
      }
    };
    views_[c].watching = time - image.time <= setup_.options.window;
    if (views_[c].watching) {
      std::for_each(image.free.begin(), image.free.end(), add);
      for (const BodySpot& spot : image.taken) {
        if (needed_spots_[spot.body] && !spot.is_further)
          add(spot.pixel);
      }
    }
    views_[c].full = true;  // no cost for a missed LED: the body may hide it
    views_[c].sights = sights_[c].data();
    views_[c].count = sights_[c].size();
  }
  const association::Association& found = associator_.associate(views_);
  points_.clear();
  for (const association::AssociatedPoint& point : found.points)
    points_.push_back({point.point.position,
                       std::hypot(std::sqrt(point.point.covariance.trace() / 3.0) / kWindowNoise,
                                  setup_.options.window_motion),
                       false});
  return found;
}

void BodySearch::listMatchedSpots(std::size_t body,
                                  const Match& match,
                                  const association::Association& found) {
  matched_spots_.clear();
  for (std::size_t led = 0; led < setup_.bodies[body].constellation.leds.size(); ++led) {
    if (match.point_of_led[led] == kUnseen)
      continue;
    for (const association::SpotReference& spot : found.points[match.point_of_led[led]].spots)
      matched_spots_.push_back({led, spot.view, candidates_[spot.view][spot.spot]});
  }
}

/// @returns false, and does nothing, if the matched spots are too few or do not fit one pose.
bool BodySearch::start(std::size_t body, const Match& match, double time) {
  if (matched_spots_.size() < *needed_spots_[body])
    return false;
  observations_.clear();
  for (const MatchedSpot& spot : matched_spots_)
    observations_.push_back({&setup_.cameras[spot.camera],
                             setup_.bodies[body].constellation.leds[spot.led], spot.pixel});
  // Motion within the window counts as noise; later images determine the velocity.
  const double noise = kWindowNoise * setup_.options.pixel_stddev;
  const auto solved =
      solvePose(observations_.data(), observations_.size(), match.world_from_body, noise);
  if (!solved || solved->reprojection_error > 3.0 * noise)
    return false;
  KnownBody started(setup_.options, time, *solved, matched_spots_.size());
  std::optional<KnownBody>& known = state_.bodies[body];
  if (known) {
    started.first_seen = known->first_seen;
    started.filter.distrustAfter(known->filter, time);
  }
  known = started;
  return true;
}

}  // namespace wiimote_tracker::body
