#include "wiimote_tracker_triangulation/body/body_tracker.h"

#include "wiimote_tracker_triangulation/association/assign_spots.h"
#include "wiimote_tracker_triangulation/association/shared_views.h"
#include "wiimote_tracker_triangulation/body/solve_pose.h"
#include "wiimote_tracker_triangulation/geometry/sight.h"

#include <algorithm>
#include <cmath>

namespace wiimote_tracker::body {
namespace {

/// The poses that fit spots worse than this were matched by chance [1]; see Body::surprise.
constexpr double kAbsurd = 6.0;
constexpr double kSurpriseMemory = 0.03;  // share of each new spot in the running mean

/// Within the window everything moves: rays miss each other by so many times the pixels' noise.
constexpr double kWindowNoise = 4.0;

/// Which LED of which body a column of the assignment stands for.
struct Column {
  std::size_t body;
  std::size_t led;
};

association::AssociationOptions associationOptions(const BodyTrackerOptions& options) {
  association::AssociationOptions result;
  result.pixel_stddev = kWindowNoise * options.pixel_stddev;
  return result;
}

}  // namespace

BodyTracker::BodyTracker(const geometry::Rig& rig,
                         const std::vector<Constellation>& constellations,
                         const BodyTrackerOptions& options)
    : rig_(rig),
      constellations_(constellations),
      options_(options),
      associator_(rig,
                  association::sharedViews(rig, options.maximum_range),
                  associationOptions(options)) {
  rig.check();
  for (const Constellation& constellation : constellations)
    constellation.check();
  for (const geometry::RigCamera& camera : rig_.cameras)
    cameras_.push_back(rig_.rayCamera(camera));
  reset();
}

void BodyTracker::reset() {
  state_.bodies.assign(constellations_.size(), std::nullopt);
  state_.images.assign(cameras_.size(), {});
  history_.clear();
  time_ = -std::numeric_limits<double>::infinity();
  estimates_.assign(constellations_.size(), std::nullopt);
}

bool BodyTracker::add(std::size_t camera, double time, const std::vector<Eigen::Vector2d>& pixels) {
  if (time < time_ - options_.history)
    return false;
  // Those that were taken too early are taken again, after this one.
  std::deque<Entry> again;
  while (!history_.empty() && history_.back().time > time) {
    state_ = std::move(history_.back().before);
    again.push_front(std::move(history_.back()));
    history_.pop_back();
  }
  take(camera, time, pixels);
  for (const Entry& entry : again)
    take(entry.camera, entry.time, entry.pixels);
  time_ = std::max(time_, time);
  while (history_.front().time < time_ - options_.history)
    history_.pop_front();
  estimate();
  return true;
}

void BodyTracker::take(std::size_t camera,
                       double time,
                       const std::vector<Eigen::Vector2d>& pixels) {
  history_.push_back({camera, time, pixels, state_});
  follow(camera, time, pixels);
  dropLost(time);
  find(time);
}

void BodyTracker::follow(std::size_t camera,
                         double time,
                         const std::vector<Eigen::Vector2d>& pixels) {
  const geometry::Camera& view = cameras_[camera];
  association::SpotCosts costs;
  std::array<Column, association::kMaximumTracks> columns;
  const std::size_t spots = std::min(pixels.size(), association::kMaximumSpots);
  std::size_t tracks = 0;
  for (std::size_t b = 0; b < state_.bodies.size(); ++b) {
    if (!state_.bodies[b])
      continue;
    state_.bodies[b]->filter.predict(time);
    for (std::size_t led = 0; led < constellations_[b].leds.size(); ++led) {
      if (tracks < association::kMaximumTracks)
        columns[tracks++] = {b, led};
    }
  }
  // Nothing is known about which LEDs the body itself hides; so a missing one costs nothing, and as
  // many spots as possible find an LED.
  costs.reset(spots, tracks, options_.gate, 0.0);
  for (std::size_t t = 0; t < tracks; ++t) {
    const auto prediction = state_.bodies[columns[t].body]->filter.predictLed(
        view, constellations_[columns[t].body].leds[columns[t].led], options_.pixel_stddev);
    if (!prediction)
      continue;
    const Eigen::Matrix2d information = prediction->covariance.inverse();
    for (std::size_t s = 0; s < spots; ++s) {
      const Eigen::Vector2d innovation = pixels[s] - prediction->pixel;
      const double squared = innovation.dot(information * innovation);
      if (squared < options_.gate)
        costs.pair[s][t] = squared;
    }
  }
  const association::SpotAssignment assignment = association::assignSpots(costs);

  LastImage& image = state_.images[camera];
  image.time = time;
  image.free.clear();
  for (std::size_t s = 0; s < pixels.size(); ++s) {
    const int track = s < spots ? assignment.track_of_spot[s] : association::kGhost;
    if (track == association::kGhost) {
      if (geometry::sightFromPixel(view, pixels[s]))
        image.free.push_back(pixels[s]);
      continue;
    }
    const Column& column = columns[static_cast<std::size_t>(track)];
    Body& body = *state_.bodies[column.body];
    const auto prediction = body.filter.predictLed(
        view, constellations_[column.body].leds[column.led], options_.pixel_stddev);
    if (!prediction)
      continue;
    const Eigen::Vector2d innovation = pixels[s] - prediction->pixel;
    const double squared = innovation.dot(prediction->covariance.inverse() * innovation);
    body.surprise += kSurpriseMemory * (0.5 * squared - body.surprise);
    body.filter.update(*prediction, pixels[s], options_.pixel_stddev);
    body.last_observed = time;
    body.led_time[column.led] = time;
    body.led_deviation[column.led] = innovation.norm() * prediction->depth / view.intrinsics.fx;
  }
}

void BodyTracker::dropLost(double time) {
  for (std::optional<Body>& body : state_.bodies) {
    if (body && (time - body->last_observed > options_.prediction_time ||
                 body->surprise > kAbsurd || !body->filter.poseCovariance().allFinite()))
      body.reset();
  }
}

void BodyTracker::find(double time) {
  if (std::all_of(state_.bodies.begin(), state_.bodies.end(),
                  [](const auto& body) { return body.has_value(); }))
    return;
  std::vector<std::vector<geometry::Sight>> sights(cameras_.size());
  std::vector<association::View> views(cameras_.size());
  for (std::size_t c = 0; c < cameras_.size(); ++c) {
    const LastImage& image = state_.images[c];
    views[c].watching = time - image.time <= options_.window;
    if (!views[c].watching)
      continue;
    for (const Eigen::Vector2d& pixel : image.free)
      sights[c].push_back(*geometry::sightFromPixel(cameras_[c], pixel));
    views[c].sights = sights[c].data();
    views[c].count = sights[c].size();
    views[c].full = true;  // the body itself may hide its LEDs: nothing was missed for sure
  }
  const association::Association& found = associator_.associate(views);

  std::vector<MeasuredPoint> points;
  for (const association::AssociatedPoint& point : found.points)
    points.push_back({point.point.position,
                      std::hypot(std::sqrt(point.point.covariance.trace() / 3.0) / kWindowNoise,
                                 options_.window_motion),
                      false});
  for (std::size_t b = 0; b < state_.bodies.size(); ++b) {
    if (state_.bodies[b])
      continue;
    const std::optional<Match> match = matchPoints(constellations_[b], points, options_.match);
    if (!match || match->margin < options_.minimum_margin || !start(b, *match, found, time))
      continue;
    for (const int p : match->point_of_led) {
      if (p != kUnseen)
        points[static_cast<std::size_t>(p)].taken = true;
    }
  }
}

bool BodyTracker::start(std::size_t body,
                        const Match& match,
                        const association::Association& found,
                        double time) {
  std::vector<LedObservation> observations;
  for (std::size_t led = 0; led < constellations_[body].leds.size(); ++led) {
    if (match.point_of_led[led] == kUnseen)
      continue;
    const association::AssociatedPoint& point =
        found.points[static_cast<std::size_t>(match.point_of_led[led])];
    for (std::size_t i = 0; i < point.spot_count; ++i) {
      const association::SpotReference& spot = found.spots[point.first_spot + i];
      observations.push_back({&cameras_[spot.view], constellations_[body].leds[led],
                              state_.images[spot.view].free[spot.spot]});
    }
  }
  // What moves within the window counts as noise; the motion is found by the images to come.
  const double noise = kWindowNoise * options_.pixel_stddev;
  const auto solved =
      solvePose(observations.data(), observations.size(), match.world_from_body, noise);
  if (!solved || solved->reprojection_error > 3.0 * noise)
    return false;
  Body started{PoseFilter(options_.motion, time, solved->world_from_body, solved->covariance),
               time,
               1.0,
               {},
               {}};
  started.led_time.fill(-std::numeric_limits<double>::infinity());
  started.led_deviation.fill(std::numeric_limits<double>::quiet_NaN());
  state_.bodies[body] = started;
  return true;
}

void BodyTracker::estimate() {
  for (std::size_t b = 0; b < state_.bodies.size(); ++b) {
    estimates_[b].reset();
    if (!state_.bodies[b])
      continue;
    const Body& body = *state_.bodies[b];
    PoseFilter now = body.filter;
    now.predict(time_);
    BodyEstimate estimate;
    estimate.tracked = time_ - body.last_observed <= options_.tracked_time;
    estimate.world_from_body = now.worldFromBody();
    estimate.covariance = now.poseCovariance();
    estimate.velocity = now.velocity();
    estimate.angular_velocity = now.angularVelocity();
    estimate.last_observed = body.last_observed;
    for (std::size_t led = 0; led < kMaximumLeds; ++led)
      estimate.deviation[led] = time_ - body.led_time[led] <= options_.tracked_time
                                    ? body.led_deviation[led]
                                    : std::numeric_limits<double>::quiet_NaN();
    estimates_[b] = estimate;
  }
}

}  // namespace wiimote_tracker::body
