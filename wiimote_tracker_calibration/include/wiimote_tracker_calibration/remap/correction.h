#ifndef WIIMOTE_TRACKER_CALIBRATION_REMAP_CORRECTION_H
#define WIIMOTE_TRACKER_CALIBRATION_REMAP_CORRECTION_H

#include "wiimote_tracker_calibration/remap/convex_hull.h"
#include "wiimote_tracker_calibration/remap/frame.h"
#include "wiimote_tracker_calibration/remap/remap.h"

#include <Eigen/Core>

#include <optional>
#include <string>

namespace wiimote_tracker::remap {

/// A point after the correction.
struct CorrectedPoint {
  Eigen::Vector3d position;    ///< World [m].
  Eigen::Matrix3d covariance;  ///< World [m^2].
  Eigen::Matrix3d jacobian;    ///< d position / d measured position [1].
  /// Whether the measured point lies in the hull of the support. Outside, the position is an
  /// extrapolation that nothing vouches for: do not publish it as if it were measured.
  bool inside = false;
};

/// A Remap made ready for use with one rig.
class Correction {
 public:
  /// @param rig_id of the rig whose points are to be corrected (geometry::Rig::id()).
  /// @throws RemapError: the correction was measured with another calibration; its number of
  /// parameters does not fit its model; values that are not finite; support without volume.
  Correction(const Remap& remap, const std::string& rig_id);

  const Remap& remap() const { return remap_; }
  const ConvexHull& hull() const { return hull_; }

  /// Never allocates. Nothing where the model has no value (a projective one behind its vanishing
  /// plane) or for a point that is not finite. The covariance is J S J' with the model's derivative
  /// J; the error of the correction itself (FitReport::expected_error) is not in it.
  std::optional<CorrectedPoint> apply(const Eigen::Vector3d& measured,
                                      const Eigen::Matrix3d& covariance) const;

 private:
  Remap remap_;
  Frame frame_;
  ConvexHull hull_;
};

}  // namespace wiimote_tracker::remap

#endif  // WIIMOTE_TRACKER_CALIBRATION_REMAP_CORRECTION_H
