#ifndef WIIMOTE_TRACKER_CALIBRATION_SRC_HEALTH_RESIDUAL_MEAN_H
#define WIIMOTE_TRACKER_CALIBRATION_SRC_HEALTH_RESIDUAL_MEAN_H

#include "wiimote_tracker_calibration/health/drift_watch.h"

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <vector>

namespace wiimote_tracker::health {

/// One residual of a camera, and what an error of the calibration makes of it.
struct Residual {
  Eigen::Vector2d value;          ///< [px]
  Eigen::MatrixXd by_parameters;  ///< 2 x all parameters of the rig; empty: not worked out.
};

/// With fewer nothing is said.
constexpr std::size_t kLeastResiduals = 40;

/// Of as many residuals the derivative is worked out; their mean stands for that of all.
constexpr std::size_t kDerivatives = 40;

/// The mean, robust to wrong spots (median), beside what noise and calibration let expect.
/// @param covariance of all parameters of the rig; empty: unknown.
/// @param dimensions 2, or 1 when only x is meant.
/// @param limit of the mean [px].
/// @returns nothing with fewer than kLeastResiduals.
std::optional<Drift> meanOf(const std::vector<Residual>& residuals,
                            const Eigen::MatrixXd& covariance,
                            int dimensions,
                            double limit);

}  // namespace wiimote_tracker::health

#endif  // WIIMOTE_TRACKER_CALIBRATION_SRC_HEALTH_RESIDUAL_MEAN_H
