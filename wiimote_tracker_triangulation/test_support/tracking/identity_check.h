#pragma once

#include "tracking/paths.h"
#include "wiimote_tracker_triangulation/tracking/snapshot.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

namespace wiimote_tracker::tracking::test {

/// Id of the tracked LED nearest to each true one; -1: none within a distance [m].
std::vector<std::int64_t> idsAt(const Snapshot& snapshot,
                                const std::vector<Path>& leds,
                                double within);

/// Compares snapshots with the true positions.
class IdentityCheck {
 public:
  /// Largest distance of a track from its LED [m].
  static constexpr double kNear = 0.1;

  explicit IdentityCheck(const std::vector<Path>& leds) : leds_(leds), last_ids_(leds.size(), -1) {}

  void add(const Snapshot& snapshot);

  std::uint64_t snapshots = 0;
  std::uint64_t switches = 0;      ///< A track switched to another LED.
  std::uint64_t renamed = 0;       ///< An LED's track ended, and it got a new one.
  std::uint64_t uncovered = 0;     ///< LEDs in snapshots without a confirmed track near.
  std::uint64_t false_tracks = 0;  ///< Tracked in snapshots where no LED is near.
  double squared_error = 0.0;      ///< Of those near [m^2], summed.
  std::uint64_t near = 0;

  double rms() const;

  /// Ids of the tracks that each LED last had; -1: none yet.
  const std::vector<std::int64_t>& ids() const { return last_ids_; }

 private:
  std::vector<Path> leds_;
  std::vector<std::int64_t> last_ids_;
  std::map<std::uint32_t, std::size_t> led_of_id_;
};

}  // namespace wiimote_tracker::tracking::test
