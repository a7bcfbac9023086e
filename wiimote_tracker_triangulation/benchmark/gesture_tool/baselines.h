#pragma once

#include "wiimote_tracker_triangulation/gesture/shape.h"

#include <Eigen/Core>

#include <array>

namespace wiimote_tracker::gesture_tool {

/// A path as in the template recognisers of the literature: resampled at equal distances, mean
/// zero.
using Cloud = std::array<Eigen::Vector3d, gesture::Shape::kPoints>;

/// Scaled by the largest side of its bounding box. @throws Error: no length.
Cloud cloudOf(const gesture::Path& path);

/// $P (Vatavu, Anthony, Wobbrock, ICMI 2012), in three dimensions: greedy matching of two clouds
/// from several starts (epsilon 0.5), both ways, with falling weights.
double pointCloudDistance(const Cloud& a, const Cloud& b);

/// Dynamic time warping of the positions without a band (Sakoe and Chiba 1978), Euclidean cost.
double timeWarpingDistance(const Cloud& a, const Cloud& b);

}  // namespace wiimote_tracker::gesture_tool
