#ifndef WIIMOTE_TRACKER_CALIBRATION_SQUARE_LENS_PRIOR_H
#define WIIMOTE_TRACKER_CALIBRATION_SQUARE_LENS_PRIOR_H

#include "adjust/lens_prior.h"

#include "wiimote_tracker_calibration/square/rig_model.h"

namespace wiimote_tracker::square {

/// Prior of a lens around its starting values.
inline adjust::LensPrior lensPrior(const geometry::Intrinsics& start, const Uncertainty& stated) {
  return {start, stated.focal, stated.aspect, stated.principal_point, stated.k1};
}

}  // namespace wiimote_tracker::square

#endif  // WIIMOTE_TRACKER_CALIBRATION_SQUARE_LENS_PRIOR_H
