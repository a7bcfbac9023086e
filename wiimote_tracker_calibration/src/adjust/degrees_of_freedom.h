#ifndef WIIMOTE_TRACKER_CALIBRATION_SRC_ADJUST_DEGREES_OF_FREEDOM_H
#define WIIMOTE_TRACKER_CALIBRATION_SRC_ADJUST_DEGREES_OF_FREEDOM_H

#include <ceres/problem.h>

#include <vector>

namespace wiimote_tracker::adjust {

/// What to expect of the sum of squares of some whitened residuals at the solution of a problem
/// without loss functions: their number less what the fit takes, the trace of J C J^T with their
/// Jacobian J and the covariance C of the parameters (Foerstner 1979: redundancy numbers). Their
/// number when some parameter is not determined.
double degreesOfFreedom(ceres::Problem* problem,
                        const std::vector<ceres::ResidualBlockId>& residuals);

}  // namespace wiimote_tracker::adjust

#endif  // WIIMOTE_TRACKER_CALIBRATION_SRC_ADJUST_DEGREES_OF_FREEDOM_H
