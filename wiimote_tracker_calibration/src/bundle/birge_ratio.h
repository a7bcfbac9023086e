#ifndef WIIMOTE_TRACKER_CALIBRATION_SRC_BUNDLE_BIRGE_RATIO_H
#define WIIMOTE_TRACKER_CALIBRATION_SRC_BUNDLE_BIRGE_RATIO_H

#include "wiimote_tracker_calibration/bundle/reconstruction.h"
#include "wiimote_tracker_calibration/bundle/solve.h"

namespace wiimote_tracker::bundle {

/// How many times farther than their covariance says the lenses move when a part of the
/// observations decides: halves of the points in time and in space, and all cameras but one.
/// Residuals that are not independent, and lens terms that are not modelled, make it larger than 1
/// (Birge 1932). At least 1; 1 too when the parts do not determine the lenses.
double birgeRatio(const Reconstruction& adjusted, const Options& options);

}  // namespace wiimote_tracker::bundle

#endif  // WIIMOTE_TRACKER_CALIBRATION_SRC_BUNDLE_BIRGE_RATIO_H
