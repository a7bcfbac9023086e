#include "body/body_fit.h"

#include "tracking/camera_fit.h"
#include "wiimote_tracker_triangulation/geometry/triangulate.h"
#include "wiimote_tracker_triangulation/tracking/snapshot.h"

#include <Eigen/Core>

#include <algorithm>

namespace wiimote_tracker::body {
namespace {

bool isInView(const Eigen::Vector2d& pixel, std::size_t camera, const BodySetup& setup) {
  return setup.cameras[camera].intrinsics.isInImage(pixel, 0.0) &&
         !geometry::isMasked(setup.rig.cameras[camera].masks, pixel);
}

/// Other cameras whose newest image shows an LED, lately.
tracking::CameraList othersSeeing(const SpotLed& led,
                                  const BodyImage& image,
                                  const BodySetup& setup,
                                  const BodyState& state) {
  tracking::CameraList others;
  for (std::size_t c = 0; c < state.images.size() && others.size() < others.capacity(); ++c) {
    const LastImage& other = state.images[c];
    if (c != image.camera && image.time - other.time <= setup.options.tracked_time &&
        std::any_of(other.taken.begin(), other.taken.end(), [&](const BodySpot& spot) {
          return spot.body == led.body && spot.led == led.led;
        }))
      others.push_back(c);
  }
  return others;
}

/// From a pixel to the nearest free spot that calibration errors may explain [px].
std::optional<Eigen::Vector2d> toNearestFree(const Eigen::Vector2d& pixel,
                                             const BodyImage& image,
                                             const LedAssignment& assignment) {
  double least = tracking::kFarthestByCalibration;
  std::optional<Eigen::Vector2d> nearest;
  for (std::size_t s = 0; s < image.pixels.size(); ++s) {
    const Eigen::Vector2d difference = image.pixels[s] - pixel;
    if (assignment.led_of_spot[s] || !(difference.norm() < least))
      continue;
    least = difference.norm();
    nearest = difference;
  }
  return nearest;
}

/// Whether all rays meet. @param greatest_miss due to noise and the calibration [m]
bool areOfOneLight(const std::vector<geometry::Sight>& sights, double greatest_miss) {
  geometry::TriangulationOptions options;
  options.method = geometry::TriangulationMethod::kLeastSquares;
  const auto light = geometry::triangulate(sights.data(), sights.size(), options);
  return light && std::all_of(sights.begin(), sights.end(), [&](const geometry::Sight& sight) {
           return sight.direction.cross(light->position - sight.origin).norm() < greatest_miss;
         });
}

}  // namespace

std::array<bool, kMaximumLeds> LedAssignment::ledsWithSpot(std::size_t body) const {
  std::array<bool, kMaximumLeds> has_spot{};
  for (const std::optional<SpotLed>& spot : led_of_spot) {
    if (spot && spot->body == body)
      has_spot[spot->led] = true;
  }
  return has_spot;
}

tracking::LedFit fitOf(const BodyImage& image,
                       const LedAssignment& assignment,
                       const BodySetup& setup,
                       const BodyState& state) {
  const auto& partners = setup.partners[image.camera];
  const bool is_pair = partners.size() == 1 && setup.partners[partners[0]].size() == 1;
  const auto& led_of_spot = assignment.led_of_spot;
  const std::size_t free = std::count(led_of_spot.begin(), led_of_spot.end(), std::nullopt);
  tracking::LedFit fit;
  for (std::size_t b = 0; b < state.bodies.size(); ++b) {
    const auto has_spot = assignment.ledsWithSpot(b);
    tracking::LedFit leds;
    for (const LedCandidate& led : assignment.candidates) {
      if (led.body != b || !led.prediction || !isInView(led.prediction->pixel, image.camera, setup))
        continue;
      const tracking::CameraList others = othersSeeing(led, image, setup, state);
      const bool is_missing = !has_spot[led.led] && others.size() >= (is_pair ? 1 : 2);
      leds.shown += has_spot[led.led] && !others.empty();
      leds.missing += is_missing;
      if (!is_missing)
        continue;
      const auto residual = toNearestFree(led.prediction->pixel, image, assignment);
      leds.explained +=
          residual &&
          tracking::isByCalibration(setup.rig,
                                    state.bodies[b]->filter.state().worldFromBody() *
                                        setup.bodies[b].constellation.leds[led.led],
                                    image.camera, others, *residual, led.prediction->covariance);
    }
    leds.missing = std::min(leds.missing, free);
    const bool is_missing =
        leds.missing > leds.shown || (leds.missing == leds.shown && leds.missing > 1);
    fit.shown += !is_missing && leds.shown > 0;
    fit.missing += is_missing;
    fit.explained += is_missing && 2 * leds.explained > leds.missing;
  }
  return fit;
}

bool isSeen(std::size_t body,
            std::size_t camera,
            const BodySetup& setup,
            const BodyState& state,
            std::vector<geometry::Sight>* sights) {
  constexpr double kGreatestMiss = 0.02;   // of a light's rays [m]
  constexpr double kGreatestShare = 0.25;  // of the distance to the nearest LED
  constexpr double kGreatestMisfit = 2.5;  // mean over the coordinates; 1 in the mean for a body
  const LastImage& image = state.images[camera];
  const std::vector<Eigen::Vector3d>& leds = setup.bodies[body].constellation.leds;
  const auto isItsSpot = [body](const BodySpot& spot) {
    return spot.body == body && !spot.is_further;
  };
  const std::size_t spots = image.countSpots(body);
  std::array<bool, kMaximumLeds> seen{};
  double misfit = 0.0;
  double coordinates = 0.0;
  double greatest_miss = kGreatestMiss;
  sights->clear();
  for (std::size_t c = 0; c < state.images.size(); ++c) {
    const LastImage& other = state.images[c];
    if (image.time - other.time > setup.options.tracked_time)
      continue;
    for (const BodySpot& spot : other.taken) {
      if (!isItsSpot(spot))
        continue;
      seen[spot.led] = true;
      misfit += spot.misfit;
      coordinates += 2.0;
      if (spots > 1)
        continue;
      greatest_miss = std::min(greatest_miss, kGreatestShare * distanceToNearest(leds, spot.led));
      if (auto sight = geometry::sightFromPixel(setup.cameras[c], spot.pixel)) {
        sight->origin += (image.time - other.time) * state.bodies[body]->filter.state().velocity;
        sights->push_back(*sight);
      }
    }
  }
  if (spots == 0 || misfit > kGreatestMisfit * coordinates)
    return false;
  return spots > 1 ||
         (std::count(seen.begin(), seen.end(), true) > 2 && !areOfOneLight(*sights, greatest_miss));
}

}  // namespace wiimote_tracker::body
