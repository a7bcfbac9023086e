// Whether BodyUpdate sees a body, or other lights near its place.
#include "body/body_update.h"
#include "wiimote_tracker_triangulation/geometry/triangulate.h"

#include <algorithm>
#include <array>

namespace wiimote_tracker::body {
namespace {

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

/// Frees the spots of bodies that have been hidden for longer than some images, where this image
/// shows fewer than three of their LEDs: those could be of any lights near the prediction, and
/// would pull the body to them. Such a body must be found by its shape, if that tells its pose,
/// unless an IMU does.
void BodyUpdate::leaveToSearch(double time) {
  constexpr auto kShape = 3;  // LEDs
  const double longest = setup_.options.tracked_time + setup_.options.window;
  for (std::size_t b = 0; b < state_.bodies.size(); ++b) {
    const std::optional<KnownBody>& body = state_.bodies[b];
    const auto isItsSpot = [b](const std::optional<SpotLed>& led) { return led && led->body == b; };
    if (body && setup_.bodies[b].has_clear_shape && !body->filter.isInertial() &&
        time - body->last_observed > longest &&
        std::count_if(led_of_spot_.begin(), led_of_spot_.end(), isItsSpot) < kShape)
      std::replace_if(led_of_spot_.begin(), led_of_spot_.end(), isItsSpot, std::nullopt);
  }
}

/// Whether an image shows the body. The newest images of all cameras must fit its prediction: other
/// lights have another shape. One spot alone could be any light, unless those images show three of
/// the body's LEDs, with rays that do not all meet in one light (moved with the body to now).
bool BodyUpdate::isSeen(std::size_t body, const LastImage& image) {
  constexpr double kGreatestMiss = 0.02;   // of a light's rays [m]
  constexpr double kGreatestShare = 0.25;  // of the distance to the nearest LED
  constexpr double kGreatestMisfit = 2.5;  // mean over the coordinates; 1 in the mean for a body
  const std::vector<Eigen::Vector3d>& leds = setup_.bodies[body].constellation.leds;
  const auto isItsSpot = [body](const BodySpot& spot) {
    return spot.body == body && !spot.is_further;
  };
  const auto spots = std::count_if(image.taken.begin(), image.taken.end(), isItsSpot);
  std::array<bool, kMaximumLeds> seen{};
  double misfit = 0.0;
  double coordinates = 0.0;
  double greatest_miss = kGreatestMiss;
  sights_.clear();
  for (std::size_t c = 0; c < state_.images.size(); ++c) {
    const LastImage& other = state_.images[c];
    if (image.time - other.time > setup_.options.tracked_time)
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
      if (auto sight = geometry::sightFromPixel(setup_.cameras[c], spot.pixel)) {
        sight->origin += (image.time - other.time) * state_.bodies[body]->filter.state().velocity;
        sights_.push_back(*sight);
      }
    }
  }
  if (spots == 0 || misfit > kGreatestMisfit * coordinates)
    return false;
  return spots > 1 ||
         (std::count(seen.begin(), seen.end(), true) > 2 && !areOfOneLight(sights_, greatest_miss));
}

}  // namespace wiimote_tracker::body
