#include "coverage_layer.h"

#include <sensor_msgs/point_cloud2_iterator.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace wiimote_tracker::panel {
namespace {

constexpr float kSameHeight = 0.001f;  // [m]

}  // namespace

sensor_msgs::PointCloud2 layerAt(const sensor_msgs::PointCloud2& cells, float height) {
  const bool has_heights = std::any_of(cells.fields.begin(), cells.fields.end(),
                                       [](const auto& field) { return field.name == "z"; });
  if (!has_heights || cells.point_step == 0)
    return {};
  using Heights = sensor_msgs::PointCloud2ConstIterator<float>;
  float nearest = std::numeric_limits<float>::infinity();
  for (Heights z(cells, "z"); z != z.end(); ++z) {
    if (std::abs(*z - height) < std::abs(nearest - height))
      nearest = *z;
  }
  sensor_msgs::PointCloud2 layer = cells;
  layer.data.clear();
  auto point = cells.data.begin();
  for (Heights z(cells, "z"); z != z.end(); ++z, point += cells.point_step) {
    if (std::abs(*z - nearest) < kSameHeight)
      layer.data.insert(layer.data.end(), point, point + cells.point_step);
  }
  layer.height = 1;
  layer.width = static_cast<std::uint32_t>(layer.data.size()) / cells.point_step;
  layer.row_step = layer.width * cells.point_step;
  return layer;
}

}  // namespace wiimote_tracker::panel
