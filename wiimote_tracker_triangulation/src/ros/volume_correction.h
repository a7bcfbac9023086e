#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_VOLUME_CORRECTION_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_VOLUME_CORRECTION_H

#include "wiimote_tracker_triangulation/geometry/rig.h"
#include "wiimote_tracker_triangulation/remap/correction.h"
#include "wiimote_tracker_triangulation/tracking/snapshot.h"

#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker {

struct CorrectedSnapshot {
  tracking::Snapshot snapshot;
  std::vector<bool> remapped;  ///< Per LED: whether it lay where the correction was measured.
};

/// The rig's correction of the volume, if it has one, and the reason when it is not used.
class VolumeCorrection {
 public:
  /// @returns whether the correction changed.
  bool take(const geometry::Rig& rig);

  /// Corrects positions, velocities and their covariances; copies them if there is no correction.
  /// Outside the measured volume see remap::Correction. Does not allocate once `corrected` is warm.
  void apply(const tracking::Snapshot& snapshot, CorrectedSnapshot* corrected) const;

  /// "none", the name of the model, or "void".
  std::string state() const;

  /// Why the rig's correction is not used and what to do; empty when it is used or there is none.
  const std::string& problem() const { return problem_; }

 private:
  bool apply(tracking::TrackedLed* led) const;

  std::string rig_id_;
  std::optional<remap::Remap> remap_;
  std::optional<remap::Correction> correction_;
  std::string problem_;
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_VOLUME_CORRECTION_H
