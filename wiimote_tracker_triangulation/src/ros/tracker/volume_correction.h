#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_TRACKER_VOLUME_CORRECTION_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_TRACKER_VOLUME_CORRECTION_H

#include "wiimote_tracker_triangulation/geometry/rig.h"
#include "wiimote_tracker_triangulation/remap/correction.h"
#include "wiimote_tracker_triangulation/tracking/snapshot.h"

#include <optional>
#include <string>

namespace wiimote_tracker {

/// The rig's correction of the volume, if it has one, and the reason when it is not used.
class VolumeCorrection {
 public:
  /// @returns whether the correction changed.
  bool take(const geometry::Rig& rig);

  /// Corrects positions, velocities and their covariances, and says which LEDs are remapped.
  /// Outside the measured volume see remap::Correction. Does not allocate.
  void apply(tracking::Snapshot* snapshot) const;

  /// "none", the name of the model, or "void".
  std::string state() const;

  /// Why the rig's correction is not used and what to do; empty when it is used or there is none.
  const std::string& problem() const { return problem_; }

 private:
  std::string rig_id_;
  std::optional<remap::Remap> remap_;
  std::optional<remap::Correction> correction_;
  std::string problem_;
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_TRACKER_VOLUME_CORRECTION_H
