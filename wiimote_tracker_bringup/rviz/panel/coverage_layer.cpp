#include "coverage_layer.h"

#include <sensor_msgs/point_cloud2_iterator.h>
#include <wiimote_tracker_msgs/text.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace wiimote_tracker::panel {
namespace {

constexpr float kSamePlace = 0.001f;  // [m]

using Coordinates = sensor_msgs::PointCloud2ConstIterator<float>;

bool has(const sensor_msgs::PointCloud2& cells, const char* name) {
  return cells.point_step > 0 && std::any_of(cells.fields.begin(), cells.fields.end(),
                                             [&](const auto& field) { return field.name == name; });
}

}  // namespace

float cellSizeOf(const sensor_msgs::PointCloud2& cells) {
  float size = std::numeric_limits<float>::infinity();
  for (const char* axis : {"x", "y", "z"}) {
    std::vector<float> places;
    if (has(cells, axis)) {
      for (Coordinates place(cells, axis); place != place.end(); ++place) {
        if (std::isfinite(*place))
          places.push_back(*place);
      }
    }
    std::sort(places.begin(), places.end());
    for (std::size_t i = 1; i < places.size(); ++i) {
      if (places[i] - places[i - 1] > kSamePlace)
        size = std::min(size, places[i] - places[i - 1]);
    }
  }
  return size;
}

sensor_msgs::PointCloud2 layerAt(const sensor_msgs::PointCloud2& cells, float height) {
  if (!has(cells, "z"))
    return {};
  float nearest = std::numeric_limits<float>::infinity();
  for (Coordinates z(cells, "z"); z != z.end(); ++z) {
    if (std::abs(*z - height) < std::abs(nearest - height))
      nearest = *z;
  }
  sensor_msgs::PointCloud2 layer = cells;
  layer.data.clear();
  auto point = cells.data.begin();
  for (Coordinates z(cells, "z"); z != z.end(); ++z, point += cells.point_step) {
    if (std::abs(*z - nearest) < kSamePlace)
      layer.data.insert(layer.data.end(), point, point + cells.point_step);
  }
  layer.height = 1;
  layer.width = static_cast<std::uint32_t>(layer.data.size()) / cells.point_step;
  layer.row_step = layer.width * cells.point_step;
  return layer;
}

std::vector<std::array<float, 3>> placesOf(const sensor_msgs::PointCloud2& cells) {
  std::vector<std::array<float, 3>> places;
  if (!has(cells, "x") || !has(cells, "y") || !has(cells, "z"))
    return places;
  Coordinates x(cells, "x"), y(cells, "y"), z(cells, "z");
  for (; x != x.end(); ++x, ++y, ++z)
    places.push_back({*x, *y, *z});
  return places;
}

std::string numbersOf(const sensor_msgs::PointCloud2& cells, std::size_t cell) {
  if (!has(cells, "cameras") || !has(cells, "stddev"))
    return "";
  const auto index = static_cast<int>(cell);
  const float cameras = *(Coordinates(cells, "cameras") + index);
  const float stddev = *(Coordinates(cells, "stddev") + index);
  return format(cameras == 1.0f ? "%.0f camera" : "%.0f cameras", cameras) +
         (std::isfinite(stddev) ? format(", %.0f mm", 1e3 * stddev) : "");
}

}  // namespace wiimote_tracker::panel
