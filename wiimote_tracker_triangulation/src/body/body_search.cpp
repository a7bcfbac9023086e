// How BodyTracker finds bodies among the spots of several cameras.
#include "led_groups.h"
#include "wiimote_tracker_triangulation/body/body_tracker.h"

#include <algorithm>
#include <cmath>

namespace wiimote_tracker::body {
namespace {

/// LEDs move within the window, so rays miss each other by this multiple of the pixel noise.
constexpr double kWindowNoise = 4.0;

}  // namespace

std::size_t BodyTracker::LastImage::countSpots(std::size_t body) const {
  return std::count_if(taken.begin(), taken.end(),
                       [&](const auto& spot) { return spot.body == body && !spot.is_further; });
}

association::AssociationOptions BodyTracker::searchOptions() const {
  association::AssociationOptions result;
  result.pixel_stddev = kWindowNoise * options_.pixel_stddev;
  return result;
}

bool BodyTracker::isTracked(std::size_t body, double time) const {
  return state_.bodies[body] && time - state_.bodies[body]->last_observed <= options_.tracked_time;
}

/// Spots of the images in the window that the pose of a body explains, or did when it was found.
std::size_t BodyTracker::countSpots(std::size_t body, double time) const {
  std::size_t spots = 0;
  for (const LastImage& image : state_.images) {
    if (time - image.time <= options_.window)
      spots += image.countSpots(body);
  }
  const Body& known = *state_.bodies[body];
  return time - known.found_time <= options_.window ? std::max(spots, known.found_spots) : spots;
}

/// Spots that a match needs for a body to be started there. A hidden body may reappear anywhere. A
/// body that was started with LEDs exchanged stays tracked by the spots that fit by chance: its
/// right pose explains more. Nothing: the body cannot be started.
std::optional<std::size_t> BodyTracker::neededSpots(std::size_t body, double time) const {
  if (!has_clear_shape_[body])
    return std::nullopt;
  if (!isTracked(body, time))
    return 0;
  const std::size_t needed = countSpots(body, time) + 1;
  std::size_t most = 0;  // that any pose explains
  for (const LastImage& image : state_.images) {
    if (time - image.time <= options_.window)
      most +=
          std::min(constellations_[body].leds.size(), image.free.size() + image.countSpots(body));
  }
  return needed <= most ? std::make_optional(needed) : std::nullopt;
}

/// Searches the bodies after an image. Those that are tracked come first, so that no other body
/// gets their LEDs.
void BodyTracker::find(const Image& image) {
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
      const std::optional<Match> match = matchPoints(constellations_[b], points_);
      if (!match || match->margin < options_.minimum_margin)
        continue;
      listMatchedSpots(b, *match, found);
      const bool is_where_predicted =
          state_.bodies[b] && isSamePose(constellations_[b].leds, match->world_from_body,
                                         state_.bodies[b]->filter.state().worldFromBody());
      const bool goes_on = is_where_predicted && (updateByMatch(b, image) || tracked);
      if (!goes_on && !start(b, *match, time))
        continue;
      for (const int p : match->point_of_led) {
        if (p != kUnseen)
          points_[p].taken = true;
      }
    }
  }
}

/// Of the newest images: the spots without a body, and those of bodies that may be elsewhere.
const association::Association& BodyTracker::locateSpots(double time) {
  for (std::size_t c = 0; c < cameras_.size(); ++c) {
    const LastImage& image = state_.images[c];
    candidates_[c].clear();
    sights_[c].clear();
    const auto add = [&](const Eigen::Vector2d& pixel) {
      if (const auto sight = geometry::sightFromPixel(cameras_[c], pixel)) {
        candidates_[c].push_back(pixel);
        sights_[c].push_back(*sight);
      }
    };
    views_[c].watching = time - image.time <= options_.window;
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
  const association::Association& found = associator_->associate(views_);
  points_.clear();
  for (const association::AssociatedPoint& point : found.points)
    points_.push_back({point.point.position,
                       std::hypot(std::sqrt(point.point.covariance.trace() / 3.0) / kWindowNoise,
                                  options_.window_motion),
                       false});
  return found;
}

void BodyTracker::listMatchedSpots(std::size_t body,
                                   const Match& match,
                                   const association::Association& found) {
  matched_spots_.clear();
  for (std::size_t led = 0; led < constellations_[body].leds.size(); ++led) {
    if (match.point_of_led[led] == kUnseen)
      continue;
    const association::AssociatedPoint& point = found.points[match.point_of_led[led]];
    for (std::size_t i = 0; i < point.spot_count; ++i) {
      const association::SpotReference& spot = found.spots[point.first_spot + i];
      matched_spots_.push_back({led, spot.view, candidates_[spot.view][spot.spot]});
    }
  }
}

/// The body is found where it is predicted: updates it with spots of this image that it did not
/// take because the prediction is too uncertain to tell its LEDs apart. @returns whether it is seen
bool BodyTracker::updateByMatch(std::size_t body, const Image& image) {
  LastImage& last = state_.images[image.camera];
  const SpotNoise noise = noiseOf(image, last.free.size());
  for (const MatchedSpot& spot : matched_spots_) {
    const auto free = std::find(last.free.begin(), last.free.end(), spot.pixel);
    if (spot.camera != image.camera || free == last.free.end())
      continue;
    const auto prediction = predictLed(state_.bodies[body]->filter.state(), cameras_[image.camera],
                                       constellations_[body].leds[spot.led], noise);
    if (!prediction)
      continue;
    const LedGroup led{{spot.led}, *prediction};
    if (!(led.misfit(spot.pixel) < options_.gate))
      continue;
    last.free.erase(free);
    spots_taken_[std::find(image.pixels.begin(), image.pixels.end(), spot.pixel) -
                 image.pixels.begin()] = true;
    update(body, led, spot.pixel, cameras_[image.camera], &last);
  }
  const bool is_seen = isSeen(body, last);
  if (is_seen)
    state_.bodies[body]->last_observed = image.time;
  return is_seen;
}

/// @returns false, and does nothing, if the matched spots are too few or do not fit one pose.
bool BodyTracker::start(std::size_t body, const Match& match, double time) {
  if (matched_spots_.size() < *needed_spots_[body])
    return false;
  observations_.clear();
  for (const MatchedSpot& spot : matched_spots_)
    observations_.push_back(
        {&cameras_[spot.camera], constellations_[body].leds[spot.led], spot.pixel});
  // Motion within the window counts as noise; later images determine the velocity.
  const double noise = kWindowNoise * options_.pixel_stddev;
  const auto solved =
      solvePose(observations_.data(), observations_.size(), match.world_from_body, noise);
  if (!solved || solved->reprojection_error > 3.0 * noise)
    return false;
  startAt(body, *solved, time, matched_spots_.size());
  return true;
}

void BodyTracker::startAt(std::size_t body, const BodyPose& pose, double time, std::size_t spots) {
  const PoseFilter filter(options_.motion, time, pose.world_from_body, pose.covariance);
  Body started{BodyFilter(options_.motion, options_.inertial, filter), time, time, time, spots, {}};
  if (state_.bodies[body]) {
    started.first_seen = state_.bodies[body]->first_seen;
    started.filter.distrustAfter(state_.bodies[body]->filter, time);
  }
  started.led_times.fill(-std::numeric_limits<double>::infinity());
  state_.bodies[body] = started;
}

}  // namespace wiimote_tracker::body
