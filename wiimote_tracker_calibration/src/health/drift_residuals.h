#ifndef WIIMOTE_TRACKER_CALIBRATION_SRC_HEALTH_DRIFT_RESIDUALS_H
#define WIIMOTE_TRACKER_CALIBRATION_SRC_HEALTH_DRIFT_RESIDUALS_H

#include "health/drift_watch.h"

#include <wiimote_tracker_triangulation/geometry/rig.h>

#include <Eigen/Core>

#include <cstddef>
#include <deque>
#include <optional>
#include <vector>

namespace wiimote_tracker::health {

/// One residual of a camera, and its derivative by the parameters of the rig.
struct Residual {
  Eigen::Vector2d value;          ///< Predicted less observed [px].
  Eigen::MatrixXd by_parameters;  ///< 2 x all parameters of the rig; empty: not computed.
};

/// Of a camera against the point that the other active cameras see.
/// @param active per camera of the rig. Samples with fewer than two others are left out.
std::vector<Residual> residualsAgainst(const geometry::Rig& rig,
                                       const std::deque<DriftSample>& samples,
                                       const std::vector<bool>& active,
                                       std::size_t camera);

/// Of two cameras against each other: the distance across the epipolar lines, in x [px].
std::vector<Residual> residualsOfPair(const geometry::Rig& rig,
                                      const std::deque<DriftSample>& samples,
                                      std::size_t a,
                                      std::size_t b);

/// The median of the residuals, and its standard deviation from noise and calibration.
/// @param covariance of all parameters of the rig; empty: unknown.
/// @param dimensions 2, or 1 for x only. @param limit of the median [px].
/// @returns nothing with fewer than 40 residuals.
std::optional<Drift> medianDrift(const std::vector<Residual>& residuals,
                                 const Eigen::MatrixXd& covariance,
                                 int dimensions,
                                 double limit);

}  // namespace wiimote_tracker::health

#endif  // WIIMOTE_TRACKER_CALIBRATION_SRC_HEALTH_DRIFT_RESIDUALS_H
