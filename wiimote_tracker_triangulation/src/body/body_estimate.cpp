// What BodyTracker reports of the bodies.
#include "pose_uncertainty.h"
#include "wiimote_tracker_triangulation/body/body_tracker.h"

#include <limits>

namespace wiimote_tracker::body {

void BodyTracker::estimate() {
  for (std::size_t b = 0; b < state_.bodies.size(); ++b) {
    if (!state_.bodies[b]) {
      estimates_[b].reset();
      continue;
    }
    const Body& body = *state_.bodies[b];
    BodyFilter filter = body.filter;
    filter.predict(time_, inertial_[b]);
    const PoseState& now = filter.state();
    if (!estimates_[b])
      estimates_[b].emplace();
    BodyEstimate& estimate = *estimates_[b];
    estimate.tracked = time_ - body.last_observed <= options_.tracked_time;
    estimate.inertial = filter.isInertial();
    estimate.world_from_body = now.worldFromBody();
    estimate.covariance = now.covariance;
    estimate.velocity = now.velocity;
    estimate.angular_velocity = now.angular_velocity;
    estimate.first_seen = body.first_seen;
    estimate.last_observed = body.last_observed;
    estimateLeds(b, &estimate);
    if (const auto calibration = calibrationCovariance(rig_, constellations_[b], estimate))
      estimate.covariance.topLeftCorner<6, 6>() += *calibration;
  }
}

void BodyTracker::estimateLeds(std::size_t body, BodyEstimate* estimate) const {
  const Constellation& constellation = constellations_[body];
  estimate->leds.resize(constellation.leds.size());
  for (std::size_t i = 0; i < constellation.leds.size(); ++i) {
    LedEstimate& led = estimate->leds[i];
    led.position = estimate->world_from_body * constellation.leds[i];
    led.last_observed = state_.bodies[body]->led_times[i];
    led.cameras.clear();
    led.residual = led.deviation = std::numeric_limits<double>::quiet_NaN();
  }
  for (std::size_t c = 0; c < state_.images.size(); ++c) {
    if (time_ - state_.images[c].time > options_.tracked_time)
      continue;
    for (const BodySpot& spot : state_.images[c].taken) {
      if (spot.body != body)
        continue;
      LedEstimate& led = estimate->leds[spot.led];
      if (state_.images[c].time > led.last_observed)
        continue;
      led.cameras.push_back(c);
      if (state_.images[c].time == led.last_observed) {
        led.residual = spot.residual;
        led.deviation = spot.deviation;
      }
    }
  }
}

}  // namespace wiimote_tracker::body
