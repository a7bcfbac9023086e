// How an image fits the bodies that other cameras see.
#include "body/body_update.h"
#include "tracking/camera_fit.h"

#include <algorithm>

namespace wiimote_tracker::body {

/// To be called before the image updates the bodies. LEDs that a body hides, or that merge, leave
/// no free spots: only as many are missing as there are such.
void BodyUpdate::measureFit(const BodyImage& image) {
  const auto& partners = setup_.partners[image.camera];
  const bool is_pair = partners.size() == 1 && setup_.partners[partners[0]].size() == 1;
  const std::size_t free =
      std::count_if(led_of_spot_.begin(), led_of_spot_.end(), [](const auto& led) { return !led; });
  fit_ = {};
  for (std::size_t b = 0; b < state_.bodies.size(); ++b) {
    tracking::LedFit leds;
    for (const Candidate& led : candidates_) {
      if (led.body != b || !led.prediction || !isInView(led, image.camera))
        continue;
      const tracking::CameraList others = othersSeeing(led, image);
      const bool is_missing = !hasSpot(led) && others.size() >= (is_pair ? 1 : 2);
      leds.shown += hasSpot(led) && !others.empty();
      leds.missing += is_missing;
      leds.explained += is_missing && isExplained(led, others, image);
    }
    leds.missing = std::min(leds.missing, free);
    const bool is_missing =
        leds.missing > leds.shown || (leds.missing == leds.shown && leds.missing > 1);
    fit_.shown += !is_missing && leds.shown > 0;
    fit_.missing += is_missing;
    fit_.explained += is_missing && 2 * leds.explained > leds.missing;
  }
}

bool BodyUpdate::isInView(const Candidate& led, std::size_t camera) const {
  const Eigen::Vector2d& pixel = led.prediction->pixel;
  return setup_.cameras[camera].intrinsics.isInImage(pixel, 0.0) &&
         !geometry::isMasked(setup_.rig.cameras[camera].masks, pixel);
}

bool BodyUpdate::hasSpot(const SpotLed& led) const {
  return std::any_of(led_of_spot_.begin(), led_of_spot_.end(), [&](const auto& spot) {
    return spot && spot->body == led.body && spot->led == led.led;
  });
}

/// Other cameras whose newest image shows it, lately.
tracking::CameraList BodyUpdate::othersSeeing(const SpotLed& led, const BodyImage& image) const {
  tracking::CameraList others;
  for (std::size_t c = 0; c < state_.images.size() && others.size() < others.capacity(); ++c) {
    const LastImage& other = state_.images[c];
    if (c != image.camera && image.time - other.time <= setup_.options.tracked_time &&
        std::any_of(other.taken.begin(), other.taken.end(), [&](const BodySpot& spot) {
          return spot.body == led.body && spot.led == led.led;
        }))
      others.push_back(c);
  }
  return others;
}

/// Whether errors of the calibration explain where the nearest free spot is.
bool BodyUpdate::isExplained(const Candidate& led,
                             const tracking::CameraList& others,
                             const BodyImage& image) const {
  double least = tracking::kFarthestByCalibration;
  std::optional<Eigen::Vector2d> residual;
  for (std::size_t s = 0; s < image.pixels.size(); ++s) {
    const Eigen::Vector2d difference = image.pixels[s] - led.prediction->pixel;
    if (led_of_spot_[s] || !(difference.norm() < least))
      continue;
    least = difference.norm();
    residual = difference;
  }
  const Eigen::Vector3d position = state_.bodies[led.body]->filter.state().worldFromBody() *
                                   setup_.bodies[led.body].constellation.leds[led.led];
  return residual && tracking::isByCalibration(setup_.rig, position, image.camera, others,
                                               *residual, led.prediction->covariance);
}

}  // namespace wiimote_tracker::body
