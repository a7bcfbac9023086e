#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_FUSION_LED_MEMORY_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_FUSION_LED_MEMORY_H

#include "locator.h"
#include "wiimote_tracker_triangulation/fusion/instant_fuser.h"
#include "wiimote_tracker_triangulation/tracking/snapshot.h"

#include <cstddef>
#include <cstdint>
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
  void match(double time, const std::vector<Locator::Point>& points);

  /// In the order of their ids: LEDs of this instant, absent ones, and those lost at this instant.
  const std::vector<Led>& leds() const { return leds_; }

  /// Forgets all LEDs; their ids are not used again.
  void forget() { leds_.clear(); }

 private:
  using TrackState = tracking::TrackState;

  struct Pair {
    double cost;
    std::size_t led;
    std::size_t point;
  };

  void dropLost();
  void findPairs(double time, const std::vector<Locator::Point>& points);
  void endAbsent(double time);
  void update(double time, std::size_t index, const Locator::Point& point, Led* led) const;

  InstantFuserOptions options_;
  std::uint32_t next_id_ = 0;
  std::vector<Led> leds_;
  std::vector<Pair> pairs_;
  std::vector<bool> taken_;  // points
};

}  // namespace wiimote_tracker::fusion

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_FUSION_LED_MEMORY_H
