#pragma once

#include "wiimote_tracker_triangulation/remap/convex_hull.h"
#include "wiimote_tracker_triangulation/remap/model_math.h"
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
  /// Whether the measured point lies in the hull of the support. The correction was not measured
  /// outside.
  bool inside = false;
};

/// A Remap prepared for one rig. Inside the hull of the support it applies the model. Outside, the
/// displacement is that of the point where the segment from the support's mean leaves the hull: it
/// is continuous and bounded.
class Correction {
 public:
  /// @param rig_id of the rig whose points are corrected (geometry::Rig::id()).
  /// @throws Error: the correction belongs to another calibration, is not valid (see Remap::check),
  /// has a support without volume, or a model that is undefined at a point of the support.
  Correction(const Remap& remap, const std::string& rig_id);

  /// Nothing for a point that is not finite. The covariance is J S J' with the derivative J of the
  /// whole correction; it does not include the error of the correction. Never allocates.
  std::optional<CorrectedPoint> apply(const Eigen::Vector3d& measured,
                                      const Eigen::Matrix3d& covariance) const;

 private:
  Remap remap_;
  Frame frame_;
  ConvexHull hull_;
  Eigen::Vector3d middle_;  // Mean of the support, always inside [m].
};

}  // namespace wiimote_tracker::remap
