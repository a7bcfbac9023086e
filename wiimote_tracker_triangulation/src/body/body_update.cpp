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
  measureFit(image);
  LastImage& last = state_.images[image.camera];
  last.time = image.time;
  last.taken.clear();
  last.free.clear();
  taken_.assign(image.pixels.size(), false);
  for (std::size_t s = 0; s < image.pixels.size(); ++s) {
    taken_[s] = led_of_spot_[s] && (image.is_doubtful || take(s, image));
    if (!taken_[s] && !image.is_doubtful)
      last.free.push_back(image.pixels[s]);
  }
  for (std::size_t b = 0; b < state_.bodies.size(); ++b) {
    if (state_.bodies[b] && isSeen(b, last))
      state_.bodies[b]->last_observed = image.time;
  }
}

/// Assigns spots of an image to LEDs of the bodies, which are predicted to its time: led_of_spot_.
void BodyUpdate::assign(const BodyImage& image) {
  const std::vector<Eigen::Vector2d>& pixels = image.pixels;
  association::SpotCosts costs;
  const std::size_t spots = std::min(pixels.size(), association::kMaximumSpots);
  // Which LEDs the body itself hides is unknown: a missed LED costs nothing, so that as many spots
  // as possible are assigned.
  costs.reset(spots, association::kMaximumTracks, kGhostCost, 0.0);
  candidates_.clear();
  for (std::size_t b = 0; b < state_.bodies.size(); ++b) {
    if (!state_.bodies[b])
      continue;
    const LedGroups groups = groupsOf(b, image, 1.0);
    for (std::size_t led = 0; led < setup_.bodies[b].constellation.leds.size(); ++led) {
      if (candidates_.size() == association::kMaximumTracks)
        break;
      for (std::size_t s = 0; s < spots; ++s)
        costs.pair[s][candidates_.size()] = groups.cost(led, pixels[s]);
      candidates_.push_back({{b, led}, groups.single(led)});
    }
  }
  costs.tracks = candidates_.size();
  const auto track_of_spot = association::assignSpots(costs);
  led_of_spot_.assign(pixels.size(), std::nullopt);
  for (std::size_t s = 0; s < spots; ++s) {
    if (track_of_spot[s] != association::kFalseDetection)
      led_of_spot_[s] = candidates_[track_of_spot[s]];
  }
}

/// Updates the body of an assigned spot with it. False if the spot does not fit any more, since
/// each update moves the body: it is of another light, or the pose is wrong, and the search needs
/// it.
bool BodyUpdate::take(std::size_t spot, const BodyImage& image) {
  const auto [body, led] = *led_of_spot_[spot];
  const Eigen::Vector2d& pixel = image.pixels[spot];
  const std::array<bool, kMaximumLeds> has_spot = ledsWithSpot(body);
  const auto spots = static_cast<double>(std::count(has_spot.begin(), has_spot.end(), true));
  const LedGroups groups = groupsOf(body, image, spots);
  const LedGroup* group = groups.best(led, pixel, has_spot);
  if (!group)
    return hasMerged(groups, image, spot, has_spot);
  update(body, *group, pixel, image);
  return true;
}

/// Which LEDs of a body have a spot in the image that assign() was called with.
std::array<bool, kMaximumLeds> BodyUpdate::ledsWithSpot(std::size_t body) const {
  std::array<bool, kMaximumLeds> has_spot{};
  for (const std::optional<SpotLed>& spot : led_of_spot_) {
    if (spot && spot->body == body)
      has_spot[spot->led] = true;
  }
  return has_spot;
}

/// Whether a spot of the same body, other than this one, fits only as that of several LEDs.
bool BodyUpdate::hasMerged(const LedGroups& groups,
                           const BodyImage& image,
                           std::size_t spot,
                           const std::array<bool, kMaximumLeds>& has_spot) const {
  std::array<bool, kMaximumLeds> all_have_spots;
  all_have_spots.fill(true);
  for (std::size_t s = 0; s < image.pixels.size(); ++s) {
    const std::optional<SpotLed>& other = led_of_spot_[s];
    if (s != spot && other && other->body == led_of_spot_[spot]->body &&
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
  const bool is_seen = isSeen(body, last);
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
