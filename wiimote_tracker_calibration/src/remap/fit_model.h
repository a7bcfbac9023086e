#pragma once

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

/// Least squares over the points: the model alone, which has a fixed number of parameters (it is
/// not kThinPlate). Nothing when the points do not determine it.
std::optional<Remap> fitParameters(Model model, const std::vector<KnownPoint>& points);

/// The same of any model, and its errors.
std::optional<FittedModel> fitModel(Model model, const std::vector<KnownPoint>& points);

/// Distance of a point, corrected, from where it is known to be [m]; infinite where the model has
/// no value.
double errorOf(const Remap& remap, const KnownPoint& point);

}  // namespace wiimote_tracker::remap
