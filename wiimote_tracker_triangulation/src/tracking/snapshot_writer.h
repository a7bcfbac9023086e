#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_SNAPSHOT_WRITER_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_SNAPSHOT_WRITER_H

#include "camera_group.h"
#include "wiimote_tracker_triangulation/tracking/snapshot.h"
#include "wiimote_tracker_triangulation/tracking/tracker_options.h"

#include <cstddef>
#include <memory>
#include <vector>

namespace wiimote_tracker::tracking {

/// Writes a snapshot's time and its LEDs at that time, sorted by id.
class SnapshotWriter {
 public:
  using Groups = std::vector<std::unique_ptr<CameraGroup>>;

  explicit SnapshotWriter(const TrackerOptions& options) : options_(options) {}

  /// The next of successive snapshots: an LED whose track has ended since the last one is reported
  /// as lost once. Does not allocate once warm.
  void write(const Groups& groups, double time, Snapshot* snapshot);

  /// Without lost LEDs.
  void predict(const Groups& groups, double time, Snapshot* snapshot) const;

 private:
  TrackerOptions options_;
  std::vector<TrackedLed> before_;  // of the last snapshot, without the lost
};

}  // namespace wiimote_tracker::tracking

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_SNAPSHOT_WRITER_H
