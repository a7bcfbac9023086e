#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_VOLUME_CORRECTION_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_VOLUME_CORRECTION_H

#include "wiimote_tracker_triangulation/geometry/rig.h"
#include "wiimote_tracker_triangulation/geometry/triangulate.h"
#include "wiimote_tracker_triangulation/remap/correction.h"

#include <optional>
#include <string>

namespace wiimote_tracker {

/// The correction of the volume that the rig in use carries, if any, and why it is not used if so.
class VolumeCorrection {
 public:
  /// @returns whether it is another one than before.
  bool take(const geometry::Rig& rig);

  /// Corrects position and covariance. @returns whether the point lay in the volume that the
  /// correction was measured in. Outside, it is displaced as the border is (remap::Correction), and
  /// without a correction it stays as it is: then false. Never allocates.
  bool apply(geometry::TriangulatedPoint* point) const;

  /// For people: "none", the name of the model, or "void".
  std::string state() const;

  /// Why the rig's correction is not used and what to do; empty when it is, or there is none.
  const std::string& problem() const { return problem_; }

 private:
  std::string rig_id_;
  std::optional<remap::Remap> remap_;
  std::optional<remap::Correction> correction_;
  std::string problem_;
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_VOLUME_CORRECTION_H
