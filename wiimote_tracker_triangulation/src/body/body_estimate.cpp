#include "body/body_estimate.h"

#include "body/body_setup.h"
#include "body/body_state.h"
#include "pose_uncertainty.h"

#include <array>
#include <limits>

namespace wiimote_tracker::body {
namespace {

/// Writes the LEDs of a body whose pose is estimated.
void estimateLeds(const BodySetup& setup,
                  const BodyState& state,
                  std::size_t body,
                  double time,
                  BodyEstimate* estimate) {
  const Constellation& constellation = setup.bodies[body].constellation;
  std::array<double, kMaximumLeds> newest;  // time of the spot that the residual is of [s]
  newest.fill(-std::numeric_limits<double>::infinity());
  estimate->leds.resize(constellation.leds.size());
  for (std::size_t i = 0; i < constellation.leds.size(); ++i) {
    LedEstimate& led = estimate->leds[i];
    led.position = estimate->world_from_body * constellation.leds[i];
    led.last_observed = state.bodies[body]->led_times[i];
    led.cameras.clear();
    led.residual = led.deviation = std::numeric_limits<double>::quiet_NaN();
  }
  for (std::size_t c = 0; c < state.images.size(); ++c) {
    const LastImage& image = state.images[c];
    if (time - image.time > setup.options.tracked_time)
      continue;
    for (const BodySpot& spot : image.taken) {
      if (spot.body != body)
        continue;
      LedEstimate& led = estimate->leds[spot.led];
      if (image.time > led.last_observed)
        continue;
      led.cameras.push_back(c);
      if (image.time < newest[spot.led])
        continue;
      newest[spot.led] = image.time;
      led.residual = spot.residual;
      led.deviation = spot.deviation;
    }
  }
}

}  // namespace

void estimateBody(std::size_t body,
                  double time,
                  const BodySetup& setup,
                  const BodyState& state,
                  std::optional<BodyEstimate>* result) {
  if (!state.bodies[body]) {
    result->reset();
    return;
  }
  const KnownBody& known = *state.bodies[body];
  const BodyModel& model = setup.bodies[body];
  BodyFilter filter = known.filter;
  filter.predict(time, model.inertial);
  const PoseState& now = filter.state();
  if (!*result)
    result->emplace();
  BodyEstimate& estimate = **result;
  estimate.tracked = time - known.last_observed <= setup.options.tracked_time;
  estimate.inertial = filter.isInertial();
  estimate.world_from_body = now.worldFromBody();
  estimate.covariance = now.covariance;
  estimate.velocity = now.velocity;
  estimate.angular_velocity = now.angular_velocity;
  estimate.first_seen = known.first_seen;
  estimate.last_observed = known.last_observed;
  estimateLeds(setup, state, body, time, &estimate);
  if (const auto calibration = calibrationCovariance(setup.rig, model.constellation, estimate))
    estimate.covariance.topLeftCorner<6, 6>() += *calibration;
}

}  // namespace wiimote_tracker::body
