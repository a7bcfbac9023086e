#include "coverage_markers.h"

#include "../marker_parts.h"
#include "wiimote_tracker_triangulation/ros/message_fields.h"

#include <sensor_msgs/point_cloud2_iterator.h>
#include <wiimote_tracker_msgs/median.h>
#include <wiimote_tracker_msgs/text.h>

#include <array>
#include <cmath>
#include <cstdint>

namespace wiimote_tracker {
namespace {

using geometry::CoverageCell;
using markers::color;
using visualization_msgs::Marker;

constexpr double kCubeShare = 0.3;  // of a cell's size

/// Red, green, blue.
std::array<std::uint8_t, 3> colorOf(const CoverageCell& cell) {
  if (std::isnan(cell.stddev))
    return {230, 51, 51};
  const double red = 255.0 * (1.0 - markers::qualityOf(cell.stddev));
  return {static_cast<std::uint8_t>(red), 204, 51};
}

constexpr std::size_t kLongestLine = 52;  // [letters]: fits between open docks of 1280 px

/// A line for each sentence and clause, or several.
std::string inLines(std::string words) {
  std::size_t begin = 0, blank = 0;  // of the line; the last in it
  for (std::size_t i = 1; i < words.size(); ++i) {
    if (words[i] == ' ')
      blank = i;
    const bool is_over = words[i] == ' ' && (words[i - 1] == '.' || words[i - 1] == ';');
    if (is_over || (i - begin >= kLongestLine && blank > begin)) {
      words[blank] = '\n';
      begin = blank + 1;
    }
  }
  return words;
}

/// Of markers that stay.
markers::Common commonOf(const std::string& world_frame) {
  return {world_frame, 0.0, 0.0};
}

/// @param height of its lower edge above the centres of the highest cells [m]
Marker textAbove(const std::string& world_frame,
                 const std::string& ns,
                 const std::vector<CoverageCell>& cells,
                 double height,
                 const std::string& words) {
  Eigen::AlignedBox3d box;
  for (const CoverageCell& cell : cells)
    box.extend(cell.center);
  return markers::textAbove(commonOf(world_frame), ns, 1,
                            {box.center().x(), box.center().y(), box.max().z() + height},
                            inLines(words), color(1.0f, 1.0f, 1.0f, 1.0f));
}

}  // namespace

std::string sentenceOf(const std::vector<CoverageCell>& cells, const std::string& volume) {
  std::vector<double> known;
  for (const CoverageCell& cell : cells) {
    if (!std::isnan(cell.stddev))
      known.push_back(cell.stddev);
  }
  std::string text = format("%.0f %% of %s is seen by two cameras or more",
                            100.0 * geometry::coveredShare(cells), volume.c_str());
  if (known.empty())
    return text + ".";
  return text + format("; points are known to %.0f mm there (median).", 1e3 * medianOf(&known));
}

std::string sentenceOf(const geometry::CameraTurn& turn) {
  const auto words = [](double angle, const char* one_way, const char* other) {
    return format("%.0f degrees %s", std::abs(angle) * 180.0 / M_PI, angle < 0.0 ? other : one_way);
  };
  std::vector<std::string> ways;
  if (turn.right != 0.0)
    ways.push_back(words(turn.right, "to the right", "to the left"));
  if (turn.up != 0.0)
    ways.push_back(words(turn.up, "up", "down"));
  return " " + turn.camera + ", turned by " + joined(ways, " and ") +
         format(", would make it %.0f %%; then calibrate again.", 100.0 * turn.share);
}

sensor_msgs::PointCloud2 coverageCloud(const std::string& world_frame,
                                       const std::vector<CoverageCell>& cells) {
  using sensor_msgs::PointField;
  sensor_msgs::PointCloud2 cloud;
  cloud.header.frame_id = world_frame;
  sensor_msgs::PointCloud2Modifier modifier(cloud);
  modifier.setPointCloud2Fields(6, "x", 1, PointField::FLOAT32, "y", 1, PointField::FLOAT32, "z", 1,
                                PointField::FLOAT32, "rgb", 1, PointField::FLOAT32, "cameras", 1,
                                PointField::FLOAT32, "stddev", 1, PointField::FLOAT32);
  modifier.resize(cells.size());
  // Fields lie side by side: after x come y and z, after cameras stddev; rgb has blue first.
  sensor_msgs::PointCloud2Iterator<float> x(cloud, "x"), cameras(cloud, "cameras");
  sensor_msgs::PointCloud2Iterator<std::uint8_t> blue(cloud, "rgb");
  for (const CoverageCell& cell : cells) {
    const auto color = colorOf(cell);
    for (int i = 0; i < 3; ++i) {
      x[i] = static_cast<float>(cell.center[i]);
      blue[2 - i] = color[i];
    }
    cameras[0] = static_cast<float>(cell.cameras);
    cameras[1] = static_cast<float>(cell.stddev);
    ++x, ++cameras, ++blue;
  }
  return cloud;
}

visualization_msgs::MarkerArray coverageMarkers(const std::string& world_frame,
                                                const std::vector<CoverageCell>& cells,
                                                double cell_size,
                                                const std::string& sentence) {
  visualization_msgs::MarkerArray array;
  array.markers = {
      textAbove(world_frame, "coverage", cells, cell_size,
                sentence + " Red: seen by fewer than two. Green to yellow: 5 to 50 mm.")};
  return array;
}

visualization_msgs::MarkerArray volumeMarkers(const std::string& world_frame,
                                              const Eigen::AlignedBox3d& volume) {
  Marker edges = markers::marker(commonOf(world_frame), "volume", 0, Marker::LINE_LIST,
                                 markers::kLine, color(0.6f, 0.65f, 0.75f, 0.5f));
  const auto corner = [&](int bits) {  // one for each axis: whether at its upper end
    return pointOf(volume.corner(static_cast<Eigen::AlignedBox3d::CornerType>(bits)));
  };
  for (int bits = 0; bits < 8; ++bits) {
    for (const int axis : {1, 2, 4}) {
      if ((bits & axis) == 0)
        edges.points.insert(edges.points.end(), {corner(bits), corner(bits | axis)});
    }
  }
  visualization_msgs::MarkerArray array;
  array.markers = {edges};
  return array;
}

visualization_msgs::MarkerArray walkMarkers(const std::string& world_frame,
                                            const std::vector<CoverageCell>& walked,
                                            double cell_size,
                                            const std::string& sentence) {
  visualization_msgs::MarkerArray array;
  Marker cubes = markers::marker(commonOf(world_frame), "walk", 0, Marker::CUBE_LIST,
                                 Eigen::Vector3d::Constant(kCubeShare * cell_size), {});
  for (const CoverageCell& cell : walked) {
    if (cell.cameras == 0)
      continue;
    cubes.points.push_back(pointOf(cell.center));
    cubes.colors.push_back(cell.cameras == 1   ? color(0.9f, 0.2f, 0.2f, 0.8f)
                           : cell.cameras == 2 ? color(1.0f, 0.8f, 0.2f, 0.8f)
                                               : color(0.0f, 0.8f, 0.2f, 0.8f));
  }
  markers::add(cubes, &array);
  array.markers.push_back(textAbove(world_frame, "walk", walked, 2.0 * cell_size,
                                    sentence + " Red: one camera, yellow: two, green: more."));
  return array;
}

}  // namespace wiimote_tracker
