#ifndef WIIMOTE_TRACKER_DRIVER_WIIMOTE_DUPLICATE_FILTER_H
#define WIIMOTE_TRACKER_DRIVER_WIIMOTE_DUPLICATE_FILTER_H

#include "wiimote_tracker_driver/protocol/report.h"

#include <limits>
#include <optional>
#include <utility>

namespace wiimote_tracker::wiimote {

/// Finds data reports that are no new images. After it has acknowledged a report mode, a remote may
/// repeat its last data report at once (the virtual remote does). Such a report would mislead the
/// exposure clock. A repeated report has the same bytes, or arrives early for a 10 ms period.
class DuplicateFilter {
 public:
  /// The remote has acknowledged a report mode at `now` [s].
  void modeAcknowledged(double now) { acknowledged_ = now; }

  /// Whether a data report that arrived at `now` [s] is a repetition. Call it for every data
  /// report.
  bool isDuplicate(const protocol::Report& report, double now) {
    const auto acknowledged = std::exchange(acknowledged_, std::nullopt);
    if (acknowledged && now - *acknowledged < kLatestRepetition &&
        (report == last_ || now - last_arrival_ < kShortestPeriod))
      return true;
    last_ = report;
    last_arrival_ = now;
    return false;
  }

 private:
  static constexpr double kLatestRepetition = 0.0025;  ///< [s] After the acknowledgement.
  static constexpr double kShortestPeriod = 0.007;     ///< [s] Between two images.

  std::optional<double> acknowledged_;  ///< [s] Nothing once a data report has followed.
  protocol::Report last_;
  double last_arrival_ = -std::numeric_limits<double>::infinity();  ///< [s]
};

}  // namespace wiimote_tracker::wiimote

#endif  // WIIMOTE_TRACKER_DRIVER_WIIMOTE_DUPLICATE_FILTER_H
