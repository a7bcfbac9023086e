#ifndef WIIMOTE_TRACKER_CALIBRATION_SRC_BUNDLE_CHECKS_H
#define WIIMOTE_TRACKER_CALIBRATION_SRC_BUNDLE_CHECKS_H

#include "wiimote_tracker_calibration/bundle/solve.h"

namespace wiimote_tracker::bundle {

/// @throws BundleError: options or observations that cannot be, fewer than two cameras.
void checkObservations(const Reconstruction& reconstruction, const Options& options);

/// A solution that leaves most of what a camera saw unexplained is none. @throws BundleError.
void refuseUnexplained(const Reconstruction& reconstruction, const Options& options);

/// Whether what every camera saw lies on one line in its image.
bool isOnALine(const Reconstruction& reconstruction);

/// Whether one plane, or one place of all cameras, explains what any two of them saw nearly as well
/// as the solution does: to 3 times its error, or to `slack` [image widths]. Then its depth means
/// nothing.
bool isFlat(const Reconstruction& solution, const Options& options, double slack);

}  // namespace wiimote_tracker::bundle

#endif  // WIIMOTE_TRACKER_CALIBRATION_SRC_BUNDLE_CHECKS_H
