#include "health/turned_camera.h"

#include <wiimote_tracker_triangulation/geometry/linear_algebra.h>
#include <wiimote_tracker_triangulation/geometry/so3.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>

namespace wiimote_tracker::health {

namespace {

// Gate between a spot and the predicted pixel of its LED. It holds errors of the calibration, of
// the clock, and of a turn that was estimated up to 2 s ago [px].
constexpr double kGate = 12.0;
constexpr double kEdge = 8.0;  // A spot so near to the edge of the image may be cut off [px].
// An LED predicted so far outside the image may be seen if the camera was turned [px].
constexpr double kMargin = 200.0;
constexpr double kPeriod = 0.1;         // Between samples [s].
constexpr double kMemory = 2.0;         // Older samples are dropped [s].
constexpr double kLeastStep = 0.02;     // An LED moves from one sample to the next [m].
constexpr std::size_t kLeast = 12;      // Samples, and pairs, that determine a turn.
constexpr double kJudgedEvery = 0.5;    // From one judgement to the next [s].
constexpr double kContradictory = 0.2;  // Share of the samples above which a turn is looked for.
// A turn must explain this share of the possible pairs. The best turn for the other pairs may
// explain at most this share of what it explains. Where two LEDs are exchanged, half is explained.
constexpr double kExplained = 0.6;
constexpr double kRival = 0.8;
// Turns about the optical axis that are tried [rad]; in between, spots are off by up to kGate.
constexpr std::array<double, 5> kRolls = {0.0, -0.035, 0.035, -0.07, 0.07};
constexpr int kSteps = 3;
// Length of the calibrated axes beside the unit vectors of rays: where all rays are the same, they
// hold the turn about these.
constexpr double kPrior = 0.001;
constexpr double kLeastTurn = 0.002;  // A smaller turn stays within kGate [rad].

geometry::Camera turned(geometry::Camera camera, const Eigen::Matrix3d& turn) {
  camera.world_from_camera.linear() = camera.world_from_camera.linear() * turn;
  return camera;
}

}  // namespace

TurnedCamera::TurnedCamera(const geometry::Rig& rig, const geometry::RigCamera& camera)
    : calibrated_(rig.rayCamera(camera)), masks_(camera.masks), now_(calibrated_) {}

LedMatches TurnedCamera::add(double time,
                             const std::vector<Eigen::Vector3d>& leds,
                             const capture::Blobs& spots) {
  LedMatches matches = matchesOf(now_, leds, spots);
  if (!samples_.empty() && time < samples_.back().time)
    samples_.clear();
  while (!samples_.empty() && samples_.front().time < time - kMemory)
    samples_.pop_front();
  if (leds.empty() || spots.empty() || !hasMoved(leds) ||
      (!samples_.empty() && time < samples_.back().time + kPeriod))
    return matches;
  samples_.push_back({time, leds, spots, matches.isContradictory()});
  const auto contradictory = std::count_if(samples_.begin(), samples_.end(),
                                           [](const Sample& s) { return s.is_contradictory; });
  const double share = static_cast<double>(contradictory) / static_cast<double>(samples_.size());
  if (samples_.size() >= kLeast && share > kContradictory &&
      std::abs(time - last_judgement_) >= kJudgedEvery) {
    last_judgement_ = time;
    judge();
    matches = matchesOf(now_, leds, spots);
  }
  return matches;
}

bool TurnedCamera::hasMoved(const std::vector<Eigen::Vector3d>& leds) const {
  if (samples_.empty() || samples_.back().leds.size() != leds.size())
    return true;
  const std::vector<Eigen::Vector3d>& before = samples_.back().leds;
  return !std::equal(leds.begin(), leds.end(), before.begin(),
                     [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
                       return (a - b).norm() < kLeastStep;
                     });
}

/// An LED and a spot match if each is the other's nearest one, within kGate.
LedMatches TurnedCamera::matchesOf(const geometry::Camera& camera,
                                   const std::vector<Eigen::Vector3d>& leds,
                                   const capture::Blobs& spots) const {
  LedMatches matches;
  matches.spot_of.resize(leds.size());
  std::vector<std::optional<std::size_t>> led_of(spots.size());
  std::vector<double> nearest_of_led(leds.size(), kGate);
  std::vector<double> nearest_of_spot(spots.size(), kGate);
  for (std::size_t i = 0; i < leds.size(); ++i) {
    const auto pixel = camera.project(leds[i]);
    if (!pixel)
      continue;
    for (std::size_t k = 0; k < spots.size(); ++k) {
      const double distance = (spots[k] - *pixel).norm();
      if (distance < nearest_of_led[i]) {
        nearest_of_led[i] = distance;
        matches.spot_of[i] = k;
      }
      if (distance < nearest_of_spot[k]) {
        nearest_of_spot[k] = distance;
        led_of[k] = i;
      }
    }
  }
  for (std::size_t i = 0; i < leds.size(); ++i) {
    std::optional<std::size_t>& spot = matches.spot_of[i];
    if (spot && led_of[*spot] != i)
      spot.reset();
    matches.matched += spot ? 1 : 0;
    const auto pixel = camera.project(leds[i]);
    const bool is_visible =
        pixel && camera.intrinsics.isInImage(*pixel, -kEdge) && !geometry::isMasked(masks_, *pixel);
    matches.visible += is_visible || spot ? 1 : 0;
    matches.missing += is_visible && !spot ? 1 : 0;
  }
  matches.unmatched = spots.size() - matches.matched;
  return matches;
}

/// Takes the turn that explains most pairs, unless another one explains nearly as many.
void TurnedCamera::judge() {
  const std::vector<Pair> pairs = allPairs();
  std::vector<Pair> explained = agreeing(pairs);
  std::size_t possible = 0;
  geometry::Camera camera;
  for (int step = 0; step < kSteps; ++step) {
    if (explained.size() < kLeast)
      return;
    camera = turnedTo(explained);
    explained.clear();
    possible = 0;
    for (const Sample& sample : samples_) {
      const LedMatches matches = matchesOf(camera, sample.leds, sample.spots);
      for (std::size_t led = 0; led < sample.leds.size(); ++led) {
        if (matches.spot_of[led])
          explained.push_back({sample.leds[led], sample.spots[*matches.spot_of[led]]});
      }
      possible += std::min(matches.visible, sample.spots.size());
    }
  }
  std::vector<Pair> others;
  std::copy_if(pairs.begin(), pairs.end(), std::back_inserter(others), [&](const Pair& pair) {
    return std::none_of(explained.begin(), explained.end(), [&](const Pair& other) {
      return pair.led == other.led && pair.spot == other.spot;
    });
  });
  const auto count = static_cast<double>(explained.size());
  if (explained.size() >= kLeast && count >= kExplained * static_cast<double>(possible) &&
      static_cast<double>(agreeing(others).size()) <= kRival * count) {
    is_turned_ = geometry::so3::angleBetween(calibrated_.world_from_camera.linear(),
                                             camera.world_from_camera.linear()) > kLeastTurn;
    now_ = is_turned_ ? camera : calibrated_;
  }
}

std::vector<TurnedCamera::Pair> TurnedCamera::allPairs() const {
  std::vector<Pair> pairs;
  for (const Sample& sample : samples_) {
    for (const Eigen::Vector3d& led : sample.leds) {
      const auto pixel = calibrated_.project(led);
      if (!pixel || !calibrated_.intrinsics.isInImage(*pixel, kMargin))
        continue;
      for (const Eigen::Vector2d& spot : sample.spots)
        pairs.push_back({led, spot});
    }
  }
  return pairs;
}

/// The largest set of pairs with about the same offset between spot and predicted pixel, for any
/// of kRolls.
std::vector<TurnedCamera::Pair> TurnedCamera::agreeing(const std::vector<Pair>& pairs) const {
  std::vector<Pair> best;
  for (const double roll : kRolls) {
    const geometry::Camera rolled =
        turned(calibrated_, Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitZ()).toRotationMatrix());
    std::vector<Eigen::Vector2d> offsets;
    for (const Pair& pair : pairs)
      offsets.push_back(pair.spot -
                        rolled.project(pair.led).value_or(Eigen::Vector2d::Constant(std::nan(""))));
    for (const Eigen::Vector2d& center : offsets) {
      std::vector<Pair> near;
      for (std::size_t i = 0; i < pairs.size(); ++i) {
        if ((offsets[i] - center).norm() < kGate)
          near.push_back(pairs[i]);
      }
      if (near.size() > best.size())
        best = near;
    }
  }
  return best;
}

/// Least squares over the differences between the unit vectors of the spots' rays and to the LEDs
/// (Wahba's problem).
geometry::Camera TurnedCamera::turnedTo(const std::vector<Pair>& pairs) const {
  std::vector<Eigen::Vector3d> in_world;
  std::vector<Eigen::Vector3d> in_camera;
  // With its opposite, so that the means are zero and nothing but the turn is fitted.
  const auto add = [&](const Eigen::Vector3d& world, const Eigen::Vector3d& camera) {
    in_world.insert(in_world.end(), {world, -world});
    in_camera.insert(in_camera.end(), {camera, -camera});
  };
  geometry::Camera camera = calibrated_;
  const Eigen::Matrix3d orientation = camera.world_from_camera.linear();
  for (Eigen::Index i = 0; i < 3; ++i)
    add(kPrior * orientation.col(i), kPrior * Eigen::Vector3d::Unit(i));
  for (const Pair& pair : pairs) {
    if (const auto spot = camera.intrinsics.normalizedFromPixel(pair.spot))
      add((pair.led - camera.center()).normalized(), spot->homogeneous().normalized());
  }
  camera.world_from_camera.linear() = geometry::rigidAlignment(in_world, in_camera).linear();
  return camera;
}

}  // namespace wiimote_tracker::health
