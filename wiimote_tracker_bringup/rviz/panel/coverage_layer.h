#pragma once

#include <sensor_msgs/PointCloud2.h>

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace wiimote_tracker::panel {

/// Least distance of neighbours along an axis [m]; infinity: none.
float cellSizeOf(const sensor_msgs::PointCloud2& cells);

/// The points of the horizontal layer that is nearest to a height [m].
sensor_msgs::PointCloud2 layerAt(const sensor_msgs::PointCloud2& cells, float height);

/// Where the cells are [m]; none where the points have no place.
std::vector<std::array<float, 3>> placesOf(const sensor_msgs::PointCloud2& cells);

/// Such as "3 cameras, 12 mm": how many see the cell, and the standard deviation of points there.
/// Empty where the points are no cells.
std::string numbersOf(const sensor_msgs::PointCloud2& cells, std::size_t cell);

}  // namespace wiimote_tracker::panel
