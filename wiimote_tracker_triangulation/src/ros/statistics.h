#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_STATISTICS_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_STATISTICS_H

#include "wiimote_tracker_triangulation/fusion/instant_fuser.h"

#include <cstddef>
#include <vector>

namespace wiimote_tracker {

/// Counts of the instants since the last clear(), for diagnostics.
class Statistics {
 public:
  /// `latency`: from the arrival of the newest image to the publication [s].
  void add(const fusion::Instant& instant, double latency);
  void clear(std::size_t cameras);

  std::size_t instants() const { return instants_; }
  std::size_t points() const { return points_; }

  /// Share of the instants with a ray of this camera in the point [0..1]; NaN without instants.
  double shareUsed(std::size_t camera) const;

  /// Quantile of the latency [s], q in [0..1]; NaN without instants.
  double latency(double q) const;

 private:
  std::size_t instants_ = 0;
  std::size_t points_ = 0;
  std::vector<std::size_t> used_;
  std::vector<double> latencies_;
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_STATISTICS_H
