#pragma once

#include "locator.h"
#include "wiimote_tracker_triangulation/fusion/instant_fuser.h"
#include "wiimote_tracker_triangulation/tracking/snapshot.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <vector>

namespace wiimote_tracker::fusion {

/// Assigns the points of each instant to the LEDs of the instants before: nearest neighbours.
class LedMemory {
 public:
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  /// Without its rays. Position and covariance: when it was last seen.
  struct Led : tracking::TrackedLed {
    double last_seen = 0.0;  ///< Instant [s].
    std::size_t sightings = 0;
    std::size_t point = kNone;  ///< Of this instant.
  };

  explicit LedMemory(const InstantFuserOptions& options) : options_(options) {}

  /// @param points of this instant, the best first: new ones beyond maximum_leds are left out.
  void match(double time, const std::vector<Locator::Point>& points) {
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
    std::size_t count = std::count_if(
        leds_.begin(), leds_.end(), [](const Led& led) { return led.state != TrackState::kLost; });
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

  /// In the order of their ids: LEDs of this instant, absent ones, and those lost at this instant.
  const std::vector<Led>& leds() const { return leds_; }

  /// Forgets all LEDs; their ids are not used again.
  void forget() { leds_.clear(); }

 private:
  static constexpr double kSlack = 0.1;              // of the gate beyond the greatest speed [m]
  static constexpr double kTentativeAbsence = 0.05;  // [s]

  using TrackState = tracking::TrackState;

  struct Pair {
    double cost;
    std::size_t led;
    std::size_t point;
  };

  void dropLost() {
    leds_.erase(std::remove_if(leds_.begin(), leds_.end(),
                               [](const Led& led) { return led.state == TrackState::kLost; }),
                leds_.end());
  }

  /// Lists the pairs within the gate that the greatest speed allows, the most likely first: -2 log
  /// of a normal density whose width grows with the time the LED was absent.
  void findPairs(double time, const std::vector<Locator::Point>& points) {
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
  void endAbsent(double time) {
    const auto isFalse = [time](const Led& led) {
      return led.state == TrackState::kTentative && time - led.last_seen > kTentativeAbsence;
    };
    leds_.erase(std::remove_if(leds_.begin(), leds_.end(), isFalse), leds_.end());
    for (Led& led : leds_) {
      if (time - led.last_seen > options_.maximum_absence)
        led.state = TrackState::kLost;
    }
  }

  void update(double time, std::size_t index, const Locator::Point& point, Led* led) const {
    led->point = index;
    led->position = point.located.position;
    led->position_covariance = point.located.covariance;
    led->last_seen = time;
    led->last_observed = point.last_observed;
    ++led->sightings;
    if (led->sightings >= options_.confirmations)
      led->state = TrackState::kTracked;
  }

  InstantFuserOptions options_;
  std::uint32_t next_id_ = 0;
  std::vector<Led> leds_;
  std::vector<Pair> pairs_;
  std::vector<bool> taken_;  // points
};

}  // namespace wiimote_tracker::fusion
