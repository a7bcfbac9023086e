#include "body/body_update.h"

#include "led_groups.h"

#include <algorithm>
#include <cmath>

namespace wiimote_tracker::body {
namespace {

/// Cost of a false detection: greater than that of any LED.
constexpr double kGhostCost = 1e6;

}  // namespace

void BodyUpdate::follow(const BodyImage& image) {
  for (std::size_t b = 0; b < state_.bodies.size(); ++b) {
    if (state_.bodies[b])
      state_.bodies[b]->filter.predict(image.time, setup_.bodies[b].inertial);
  }
  assign(image);
  leaveToSearch(image.time);
  fit_ = fitOf(image, assignment_, setup_, state_);
  LastImage& last = state_.images[image.camera];
  last.time = image.time;
  last.taken.clear();
  last.free.clear();
  taken_.assign(image.pixels.size(), false);
  for (std::size_t s = 0; s < image.pixels.size(); ++s) {
    taken_[s] = assignment_.led_of_spot[s] && (image.is_doubtful || take(s, image));
    if (!taken_[s] && !image.is_doubtful)
      last.free.push_back(image.pixels[s]);
  }
  for (std::size_t b = 0; b < state_.bodies.size(); ++b) {
    if (state_.bodies[b] && isSeen(b, image.camera, setup_, state_, &sights_))
      state_.bodies[b]->last_observed = image.time;
  }
}

/// Assigns spots of an image to LEDs of the bodies, which are predicted to its time.
void BodyUpdate::assign(const BodyImage& image) {
  const std::vector<Eigen::Vector2d>& pixels = image.pixels;
  association::SpotCosts costs;
  const std::size_t spots = std::min(pixels.size(), association::kMaximumSpots);
  // Which LEDs the body itself hides is unknown: a missed LED costs nothing, so that as many spots
  // as possible are assigned.
  costs.reset(spots, association::kMaximumTracks, kGhostCost, 0.0);
  assignment_.candidates.clear();
  for (std::size_t b = 0; b < state_.bodies.size(); ++b) {
    if (!state_.bodies[b])
      continue;
    const LedGroups groups = groupsOf(b, image, 1.0);
    for (std::size_t led = 0; led < setup_.bodies[b].constellation.leds.size(); ++led) {
      if (assignment_.candidates.size() == association::kMaximumTracks)
        break;
      for (std::size_t s = 0; s < spots; ++s)
        costs.pair[s][assignment_.candidates.size()] = groups.cost(led, pixels[s]);
      assignment_.candidates.push_back({{b, led}, groups.single(led)});
    }
  }
  costs.tracks = assignment_.candidates.size();
  const auto track_of_spot = association::assignSpots(costs);
  assignment_.led_of_spot.assign(pixels.size(), std::nullopt);
  for (std::size_t s = 0; s < spots; ++s) {
    if (track_of_spot[s] != association::kFalseDetection)
      assignment_.led_of_spot[s] = assignment_.candidates[track_of_spot[s]];
  }
}

/// Frees the spots of bodies that have been hidden for longer than some images, where this image
/// shows fewer than three of their LEDs: those could be of any lights near the prediction, and
/// would pull the body to them. Such a body must be found by its shape, if that tells its pose,
/// unless an IMU does.
void BodyUpdate::leaveToSearch(double time) {
  auto& led_of_spot = assignment_.led_of_spot;
  constexpr auto kShape = 3;  // LEDs
  const double longest = setup_.options.tracked_time + setup_.options.window;
  for (std::size_t b = 0; b < state_.bodies.size(); ++b) {
    const std::optional<KnownBody>& body = state_.bodies[b];
    const auto isItsSpot = [b](const std::optional<SpotLed>& led) { return led && led->body == b; };
    if (body && setup_.bodies[b].has_clear_shape && !body->filter.isInertial() &&
        time - body->last_observed > longest &&
        std::count_if(led_of_spot.begin(), led_of_spot.end(), isItsSpot) < kShape)
      std::replace_if(led_of_spot.begin(), led_of_spot.end(), isItsSpot, std::nullopt);
  }
}

/// Updates the body of an assigned spot with it. False if the spot does not fit any more, since
/// each update moves the body: it is of another light, or the pose is wrong, and the search needs
/// it.
bool BodyUpdate::take(std::size_t spot, const BodyImage& image) {
  const auto [body, led] = *assignment_.led_of_spot[spot];
  const Eigen::Vector2d& pixel = image.pixels[spot];
  const std::array<bool, kMaximumLeds> has_spot = assignment_.ledsWithSpot(body);
  const auto spots = static_cast<double>(std::count(has_spot.begin(), has_spot.end(), true));
  const LedGroups groups = groupsOf(body, image, spots);
  const LedGroup* group = groups.best(led, pixel, has_spot);
  if (!group)
    return hasMerged(groups, image, spot, has_spot);
  update(body, *group, pixel, image);
  return true;
}

/// Whether a spot of the same body, other than this one, fits only as that of several LEDs.
bool BodyUpdate::hasMerged(const LedGroups& groups,
                           const BodyImage& image,
                           std::size_t spot,
                           const std::array<bool, kMaximumLeds>& has_spot) const {
  std::array<bool, kMaximumLeds> all_have_spots;
  all_have_spots.fill(true);
  for (std::size_t s = 0; s < image.pixels.size(); ++s) {
    const std::optional<SpotLed>& other = assignment_.led_of_spot[s];
    if (s != spot && other && other->body == assignment_.led_of_spot[spot]->body &&
        !groups.best(other->led, image.pixels[s], all_have_spots) &&
        groups.best(other->led, image.pixels[s], has_spot))
      return true;
  }
  return false;
}

void BodyUpdate::update(std::size_t body,
                        const LedGroup& group,
                        const Eigen::Vector2d& pixel,
                        const BodyImage& image) {
  KnownBody& known = *state_.bodies[body];
  const double residual = (pixel - group.prediction.pixel).norm();
  const double misfit = group.misfit(pixel);
  known.filter.update(group.prediction, pixel, setup_.bodies[body].inertial);
  for (std::size_t i = 0; i < group.leds.size(); ++i) {
    known.led_times[group.leds[i]] = image.time;
    state_.images[image.camera].taken.push_back(
        {body, group.leds[i], i > 0, pixel, misfit, residual,
         residual * group.prediction.depth / setup_.cameras[image.camera].intrinsics.fx});
  }
}

bool BodyUpdate::followMatch(std::size_t body,
                             const std::vector<MatchedSpot>& spots,
                             const BodyImage& image) {
  KnownBody& known = *state_.bodies[body];
  LastImage& last = state_.images[image.camera];
  const geometry::PixelNoise noise = noiseOf(image, last.free.size());
  for (const MatchedSpot& spot : spots) {
    const auto free = std::find(last.free.begin(), last.free.end(), spot.pixel);
    if (spot.camera != image.camera || free == last.free.end())
      continue;
    const auto prediction = predictLed(known.filter.state(), setup_.cameras[image.camera],
                                       setup_.bodies[body].constellation.leds[spot.led], noise);
    if (!prediction)
      continue;
    const LedGroup led{{spot.led}, *prediction};
    if (!(led.misfit(spot.pixel) < setup_.options.gate))
      continue;
    last.free.erase(free);
    taken_[std::find(image.pixels.begin(), image.pixels.end(), spot.pixel) - image.pixels.begin()] =
        true;
    update(body, led, spot.pixel, image);
  }
  const bool is_seen = isSeen(body, image.camera, setup_, state_, &sights_);
  if (is_seen)
    known.last_observed = image.time;
  return is_seen;
}

LedGroups BodyUpdate::groupsOf(std::size_t body, const BodyImage& image, double spots) const {
  return LedGroups(state_.bodies[body]->filter.state(), setup_.bodies[body].constellation,
                   setup_.cameras[image.camera], noiseOf(image, spots),
                   setup_.options.merging_distance, setup_.options.gate);
}

/// All spots of a body in an image share the error of its time: as if each had its own one, which
/// is greater. @param spots of the body
geometry::PixelNoise BodyUpdate::noiseOf(const BodyImage& image, double spots) const {
  return {geometry::pixelNoise(setup_.rig.cameras[image.camera], setup_.options.learnt_noise,
                               setup_.options.pixel_stddev),
          image.stamp_stddev * std::sqrt(spots)};
}

}  // namespace wiimote_tracker::body
