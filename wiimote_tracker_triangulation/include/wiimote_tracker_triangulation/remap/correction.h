#ifndef WIIMOTE_TRACKER_TRIANGULATION_REMAP_CORRECTION_H
#define WIIMOTE_TRACKER_TRIANGULATION_REMAP_CORRECTION_H

#include "wiimote_tracker_triangulation/remap/convex_hull.h"
#include "wiimote_tracker_triangulation/remap/frame.h"
#include "wiimote_tracker_triangulation/remap/remap.h"

#include <Eigen/Core>

#include <optional>
#include <string>

namespace wiimote_tracker::remap {

/// A point after the correction.
struct CorrectedPoint {
  Eigen::Vector3d position;    ///< World [m].
  Eigen::Matrix3d covariance;  ///< World [m^2].
  Eigen::Matrix3d jacobian;    ///< d position / d measured position [1].
  /// Whether the measured point lies in the hull of the support. Outside nothing vouches for the
  /// correction.
  bool inside = false;
};

/// A Remap made ready for use with one rig.
///
/// In the hull of the support a point goes where the model puts it. Outside no model is trusted: a
/// point is displaced as much as the place where the line to it from the middle of the support
/// leaves the hull. So the correction neither ends in a jump nor grows without bounds.
class Correction {
 public:
  /// @param rig_id of the rig whose points are to be corrected (geometry::Rig::id()).
  /// @throws Error: the correction was measured with another calibration; not valid (see
  /// Remap::check); support without volume; a model that has no value at a point of the support.
  Correction(const Remap& remap, const std::string& rig_id);

  const Remap& remap() const { return remap_; }
  const ConvexHull& hull() const { return hull_; }

  /// Never allocates. Nothing for a point that is not finite. The covariance is J S J' with the
  /// derivative J of all that is done; the error of the correction itself is not in it.
  std::optional<CorrectedPoint> apply(const Eigen::Vector3d& measured,
                                      const Eigen::Matrix3d& covariance) const;

 private:
  Remap remap_;
  Frame frame_;
  ConvexHull hull_;
  Eigen::Vector3d middle_;  // Mean of the support, which is always inside [m].
};

}  // namespace wiimote_tracker::remap

#endif  // WIIMOTE_TRACKER_TRIANGULATION_REMAP_CORRECTION_H
