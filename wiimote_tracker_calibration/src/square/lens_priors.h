#ifndef WIIMOTE_TRACKER_CALIBRATION_SQUARE_LENS_PRIORS_H
#define WIIMOTE_TRACKER_CALIBRATION_SQUARE_LENS_PRIORS_H

#include "adjust/lens_prior.h"
#include "adjust/prior.h"

#include "wiimote_tracker_calibration/square/square_model.h"

#include <ceres/problem.h>

#include <cmath>
#include <optional>

namespace wiimote_tracker::square {

/// Whether a camera starts from the default principal point, whose error such cameras share.
inline bool sharesOffset(const geometry::Intrinsics& start) {
  const geometry::Intrinsics common;
  return start.cx == common.cx && start.cy == common.cy;
}

/// Prior of one camera's lens around its starting values. The variance of the shared offset is in
/// it: marginal over the offset, for a camera by itself.
inline adjust::LensPrior marginalLensPrior(const geometry::Intrinsics& start,
                                           const Uncertainty& stated) {
  const double shared = sharesOffset(start) ? stated.shared_principal_point : 0.0;
  return {start, stated.focal, stated.aspect, std::hypot(stated.principal_point, shared),
          stated.k1};
}

/// Adds the offset that principal points share, with its prior, to a problem.
/// @param offset block (2) [px]. @returns the prior, unless the offset is held.
inline std::optional<ceres::ResidualBlockId> addSharedOffset(const Uncertainty& stated,
                                                             double* offset,
                                                             ceres::Problem* problem) {
  const double shared = stated.shared_principal_point;
  if (shared > 0.0)
    return problem->AddResidualBlock(
        adjust::priorOf(Eigen::Vector2d::Zero(), Eigen::Vector2d::Constant(shared)), nullptr,
        offset);
  problem->AddParameterBlock(offset, 2);
  problem->SetParameterBlockConstant(offset);
  return std::nullopt;
}

/// Adds the prior of a lens given the shared offset to a problem that estimates the offset.
/// @param lens block of CameraBlocks.
inline ceres::ResidualBlockId addLensPriorGivenOffset(const geometry::Intrinsics& start,
                                                      const Uncertainty& stated,
                                                      double* lens,
                                                      double* offset,
                                                      ceres::Problem* problem) {
  adjust::LensPrior own = marginalLensPrior(start, stated);
  own.principal_point = stated.principal_point;
  return sharesOffset(start)
             ? problem->AddResidualBlock(adjust::SharedLensPrior{own}.cost(), nullptr, lens, offset)
             : problem->AddResidualBlock(own.cost(), nullptr, lens);
}

}  // namespace wiimote_tracker::square

#endif  // WIIMOTE_TRACKER_CALIBRATION_SQUARE_LENS_PRIORS_H
