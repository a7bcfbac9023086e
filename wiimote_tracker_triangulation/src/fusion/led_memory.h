#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_FUSION_LED_MEMORY_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_FUSION_LED_MEMORY_H

#include "wiimote_tracker_triangulation/fusion/instant_fuser.h"
#include "wiimote_tracker_triangulation/tracking/snapshot.h"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace wiimote_tracker::fusion {

/// Which points of one instant are which LEDs of the instants before: the nearest.
class LedMemory {
 public:
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  /// An LED that was there lately.
  struct Led {
    std::uint32_t id = 0;
    tracking::TrackState state = tracking::TrackState::kTentative;
    Eigen::Vector3d position;    ///< Where it was seen last [m].
    Eigen::Matrix3d covariance;  ///< Of that [m^2].
    double first_seen = 0.0;     ///< [s]
    double last_seen = 0.0;      ///< Instant [s].
    double last_observed = 0.0;  ///< Image [s].
    std::size_t sightings = 0;
    std::size_t point = kNone;  ///< Of this instant.
  };

  /// A point of this instant.
  struct Point {
    Eigen::Vector3d position;    ///< [m]
    Eigen::Matrix3d covariance;  ///< [m^2]
    double last_observed;        ///< [s]
  };

  explicit LedMemory(const InstantFuserOptions& options) : options_(options) {}

  /// @param points of this instant, the most trustworthy first: where there are more new ones than
  /// maximum_leds allows, the last are left out.
  void match(double time, const std::vector<Point>& points);

  /// In the order of their ids: those of this instant, absent ones, and those lost just now.
  const std::vector<Led>& leds() const { return leds_; }

  /// Forgets all LEDs, but not which ids were used.
  void forget() { leds_.clear(); }

 private:
  struct Pair {
    double cost;
    std::size_t led;
    std::size_t point;
  };

  void dropLost();
  void findPairs(double time, const std::vector<Point>& points);
  void giveUpAbsent(double time);
  void take(double time, std::size_t index, const Point& point, Led* led) const;

  InstantFuserOptions options_;
  std::uint32_t next_id_ = 0;
  std::vector<Led> leds_;
  std::vector<Pair> pairs_;
  std::vector<bool> taken_;  // points
};

}  // namespace wiimote_tracker::fusion

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_FUSION_LED_MEMORY_H
