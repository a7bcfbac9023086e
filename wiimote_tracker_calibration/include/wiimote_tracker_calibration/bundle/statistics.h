#pragma once

#include "wiimote_tracker_calibration/bundle/reconstruction.h"

#include <wiimote_tracker_triangulation/geometry/rig.h>

#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

namespace wiimote_tracker::bundle {

/// Error of an observation that is no inlier [px].
constexpr double kOutlier = std::numeric_limits<double>::infinity();

/// Statistics of reprojection errors. NaN, except for the counts, if there are none.
struct Statistics {
  std::size_t observations = 0;                              ///< All, including outliers.
  std::size_t inliers = 0;                                   ///< The values below are over these.
  double rms = std::numeric_limits<double>::quiet_NaN();     ///< sqrt(mean(du^2 + dv^2)) [px].
  double mean = std::numeric_limits<double>::quiet_NaN();    ///< [px]
  double median = std::numeric_limits<double>::quiet_NaN();  ///< [px]
  double p95 = std::numeric_limits<double>::quiet_NaN();     ///< [px]
  double rms_m = std::numeric_limits<double>::quiet_NaN();   ///< At the points' distance [m].
};

/// From single errors, in their unit and without rms_m; those that are not finite are outliers'.
Statistics statisticsOf(std::vector<double> errors);

/// Of all cameras, or of one.
Statistics statistics(const Reconstruction& reconstruction,
                      std::optional<std::size_t> camera = std::nullopt);

/// Of each camera.
std::vector<Statistics> statisticsOfCameras(const Reconstruction& reconstruction);

/// The cameras as a rig, with their residuals times a factor; without method and verdict.
geometry::Rig rigOf(const Reconstruction& reconstruction, double factor = 1.0);

}  // namespace wiimote_tracker::bundle
