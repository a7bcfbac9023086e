#ifndef WIIMOTE_TRACKER_CALIBRATION_REMAP_THIN_PLATE_H
#define WIIMOTE_TRACKER_CALIBRATION_REMAP_THIN_PLATE_H

#include "wiimote_tracker_calibration/remap/fit.h"

#include <optional>
#include <vector>

namespace wiimote_tracker::remap {

/// A smoothed thin plate in three dimensions: least sum of squared distances plus smoothing times
/// bending, whose kernel is -r (Duchon 1977; Wahba, Spline Models for Observational Data, 1990).
struct ThinPlate {
  Remap remap;
  std::vector<double> left_out_errors;  ///< As leftOutErrors().
};

/// With the smoothing whose leave-one-out errors are least. Nothing if the points do not determine
/// it.
std::optional<ThinPlate> fitThinPlate(const std::vector<KnownPoint>& points);

}  // namespace wiimote_tracker::remap

#endif  // WIIMOTE_TRACKER_CALIBRATION_REMAP_THIN_PLATE_H
