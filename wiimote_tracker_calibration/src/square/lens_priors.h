#pragma once

#include "adjust/lens_prior.h"

#include "wiimote_tracker_calibration/square/square_model.h"

#include <cmath>

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

}  // namespace wiimote_tracker::square
