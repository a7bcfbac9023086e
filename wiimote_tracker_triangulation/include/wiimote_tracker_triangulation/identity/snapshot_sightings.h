#pragma once

#include "wiimote_tracker_triangulation/geometry/rig.h"
#include "wiimote_tracker_triangulation/identity/identifier.h"
#include "wiimote_tracker_triangulation/tracking/snapshot.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace wiimote_tracker::identity {

struct SnapshotSightingsOptions {
  double exposure = 0.002;  ///< Length plus the uncertainty of its time [s, 0..0.02].

  /// As for the tracker: LEDs closer than this may merge [px, 0..100].
  double merging_distance = 24.0;
};

struct TrackSighting {
  std::uint32_t led;  ///< The tracker's id.
  Sighting sighting;
};

/// Feeds an Identifier with a tracker's snapshots: for each new image, which LEDs it shows, and
/// which ones are missing although it should show them. Does not allocate once warm.
class SnapshotSightings {
 public:
  explicit SnapshotSightings(const SnapshotSightingsOptions& options) : options_(options) {}

  /// Adds the sightings of a snapshot, removes lost LEDs, and decides.
  /// @param rig the rig of the snapshot.
  void add(const geometry::Rig& rig, const tracking::Snapshot& snapshot, Identifier* identifier);

  /// Extracts the sightings of a snapshot. Valid until the next call.
  const std::vector<TrackSighting>& collect(const geometry::Rig& rig,
                                            const tracking::Snapshot& snapshot);

 private:
  void expectPixels(const geometry::Camera& camera, const tracking::Snapshot& snapshot);
  std::optional<bool> isSeen(const geometry::RigCamera& camera,
                             const tracking::CameraView& view,
                             const tracking::Snapshot& snapshot,
                             std::size_t led) const;
  bool mayBeOtherLed(const Eigen::Vector2d& pixel,
                     const tracking::Snapshot& snapshot,
                     std::size_t led) const;

  SnapshotSightingsOptions options_;
  std::vector<std::optional<Eigen::Vector2d>> pixels_;  // predicted, per LED [px]
  std::vector<TrackSighting> sightings_;
  std::vector<std::optional<double>> times_;  // of the last image, per camera [s]
};

}  // namespace wiimote_tracker::identity
