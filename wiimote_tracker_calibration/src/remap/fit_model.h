#ifndef WIIMOTE_TRACKER_CALIBRATION_REMAP_FIT_MODEL_H
#define WIIMOTE_TRACKER_CALIBRATION_REMAP_FIT_MODEL_H

#include "wiimote_tracker_calibration/remap/fit.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace wiimote_tracker::remap {

/// Least number of points with which a model can be fitted, and judged by leaving some out.
std::size_t minimumPoints(Model model);

struct FittedModel {
  Remap remap;  ///< Without rig id.
  /// Distance of each point from where the model puts it that is fitted to all others [m]. Empty
  /// when the others do not determine it.
  std::vector<double> left_out_errors;
};

/// Least squares over the points. Nothing when they do not determine the model.
std::optional<FittedModel> fitModel(Model model, const std::vector<KnownPoint>& points);

/// Distance of a point, corrected, from where it is known to be [m]; infinite where the model has
/// no value.
double errorOf(const Remap& remap, const KnownPoint& point);

}  // namespace wiimote_tracker::remap

#endif  // WIIMOTE_TRACKER_CALIBRATION_REMAP_FIT_MODEL_H
