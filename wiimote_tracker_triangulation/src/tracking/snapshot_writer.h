#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_SNAPSHOT_WRITER_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_SNAPSHOT_WRITER_H

#include "camera_group.h"
#include "wiimote_tracker_triangulation/tracking/snapshot.h"
#include "wiimote_tracker_triangulation/tracking/tracker_options.h"

#include <cstddef>
#include <memory>
#include <vector>

namespace wiimote_tracker::tracking {

/// Writes the time, and all tracks at that time sorted by id. The snapshot must have at least as
/// many LEDs as there are tracks.
void writeLeds(const std::vector<std::unique_ptr<CameraGroup>>& groups,
               double time,
               const TrackerOptions& options,
               Snapshot* snapshot);

std::size_t countTracks(const std::vector<std::unique_ptr<CameraGroup>>& groups);

/// Writes successive snapshots. An LED whose track has ended since the last snapshot is reported as
/// lost once. Does not allocate once warm.
class SnapshotWriter {
 public:
  explicit SnapshotWriter(const TrackerOptions& options) : options_(options) {}

  void write(const std::vector<std::unique_ptr<CameraGroup>>& groups,
             double time,
             Snapshot* snapshot);

 private:
  void resize(std::size_t count, std::vector<TrackedLed>* leds);

  TrackerOptions options_;
  std::vector<TrackedLed> before_;               // of the last snapshot, without the lost
  std::vector<std::vector<std::size_t>> spare_;  // storage of TrackedLed::cameras
};

}  // namespace wiimote_tracker::tracking

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_TRACKING_SNAPSHOT_WRITER_H
