#ifndef WIIMOTE_TRACKER_CALIBRATION_SRC_ADJUST_JACOBIAN_H
#define WIIMOTE_TRACKER_CALIBRATION_SRC_ADJUST_JACOBIAN_H

#include <ceres/problem.h>

#include <Eigen/Core>

#include <vector>

namespace wiimote_tracker::adjust {

/// Derivatives of some residuals by some parameter blocks of a problem, at its present values, with
/// the weights of the loss functions: rows and columns in the order given, held blocks left out.
Eigen::MatrixXd jacobianOf(ceres::Problem* problem,
                           const std::vector<ceres::ResidualBlockId>& residuals,
                           const std::vector<double*>& blocks);

}  // namespace wiimote_tracker::adjust

#endif  // WIIMOTE_TRACKER_CALIBRATION_SRC_ADJUST_JACOBIAN_H
