#include "led_memory.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace wiimote_tracker::fusion {
namespace {

constexpr double kSlack = 0.1;              // of the gate beyond the greatest speed [m]
constexpr double kTentativeAbsence = 0.05;  // [s]

}  // namespace

void LedMemory::match(double time, const std::vector<Locator::Point>& points) {
  dropLost();
  taken_.assign(points.size(), false);
  findPairs(time, points);
  for (Led& led : leds_)
    led.point = kNone;
  for (const Pair& pair : pairs_) {
    Led& led = leds_[pair.led];
    if (led.point != kNone || taken_[pair.point])
      continue;
    taken_[pair.point] = true;
    update(time, pair.point, points[pair.point], &led);
  }
  endAbsent(time);
  std::size_t count = std::count_if(leds_.begin(), leds_.end(),
                                    [](const Led& led) { return led.state != TrackState::kLost; });
  for (std::size_t i = 0; i < points.size() && count < options_.maximum_leds; ++i) {
    if (taken_[i])
      continue;
    Led led;
    led.id = next_id_++;
    led.first_seen = time;
    update(time, i, points[i], &led);
    leds_.push_back(led);
    ++count;
  }
}

void LedMemory::dropLost() {
  leds_.erase(std::remove_if(leds_.begin(), leds_.end(),
                             [](const Led& led) { return led.state == TrackState::kLost; }),
              leds_.end());
}

/// Lists the pairs within the gate that the greatest speed allows, the most likely first: -2 log
/// of a normal density whose width grows with the time the LED was absent.
void LedMemory::findPairs(double time, const std::vector<Locator::Point>& points) {
  constexpr double kStddevsOfGate = 3.0;
  pairs_.clear();
  for (std::size_t l = 0; l < leds_.size(); ++l) {
    const double gate = kSlack + options_.maximum_speed * (time - leds_[l].last_seen);
    const double stddev = gate / kStddevsOfGate;
    for (std::size_t p = 0; p < points.size(); ++p) {
      const double distance = (points[p].located.position - leds_[l].position).norm();
      if (distance <= gate)
        pairs_.push_back({std::pow(distance / stddev, 2) + 6.0 * std::log(stddev), l, p});
    }
  }
  std::sort(pairs_.begin(), pairs_.end(), [](const Pair& a, const Pair& b) {
    return std::tie(a.cost, a.led, a.point) < std::tie(b.cost, b.led, b.point);
  });
}

/// Removes absent tentative LEDs, which are never reported as lost, and ends the other absent
/// ones.
void LedMemory::endAbsent(double time) {
  const auto isFalse = [time](const Led& led) {
    return led.state == TrackState::kTentative && time - led.last_seen > kTentativeAbsence;
  };
  leds_.erase(std::remove_if(leds_.begin(), leds_.end(), isFalse), leds_.end());
  for (Led& led : leds_) {
    if (time - led.last_seen > options_.maximum_absence)
      led.state = TrackState::kLost;
  }
}

void LedMemory::update(double time,
                       std::size_t index,
                       const Locator::Point& point,
                       Led* led) const {
  led->point = index;
  led->position = point.located.position;
  led->position_covariance = point.located.covariance;
  led->last_seen = time;
  led->last_observed = point.last_observed;
  ++led->sightings;
  if (led->sightings >= options_.confirmations)
    led->state = TrackState::kTracked;
}

}  // namespace wiimote_tracker::fusion
