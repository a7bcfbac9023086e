#pragma once

#include "wiimote_tracker_triangulation/ros/message_fields.h"

#include <std_msgs/ColorRGBA.h>
#include <visualization_msgs/MarkerArray.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>

/// Shared by the markers of LEDs, bodies, coverage and gestures.
namespace wiimote_tracker::markers {

constexpr double kLineWidth = 0.01;                 // [m]
constexpr double kTextHeight = 0.18;                // [m]
const Eigen::Vector3d kLine(kLineWidth, 0.0, 0.0);  // scale of lines

inline std_msgs::ColorRGBA color(float r, float g, float b, float a) {
  std_msgs::ColorRGBA color;
  color.r = r;
  color.g = g;
  color.b = b;
  color.a = a;
  return color;
}

/// How well a position is known, from 0 (a standard deviation of 50 mm or more) to 1 (5 mm or
/// less).
inline double qualityOf(double stddev) {
  constexpr double kGood = 0.005, kBad = 0.05;  // [m]
  if (!(stddev < kBad))                         // or NaN
    return 0.0;
  return std::min(std::log(kBad / stddev) / std::log(kBad / kGood), 1.0);
}

/// What the markers of one array have in common.
struct Common {
  std::string frame;
  double time;      ///< Stamp [s].
  double lifetime;  ///< After which rviz removes it [s]; 0: never.
};

inline visualization_msgs::Marker marker(const Common& common,
                                         const std::string& ns,
                                         std::size_t id,
                                         int type,
                                         const Eigen::Vector3d& scale,
                                         const std_msgs::ColorRGBA& color) {
  visualization_msgs::Marker marker;
  marker.header.frame_id = common.frame;
  marker.header.stamp = timeOf(common.time);
  marker.lifetime = ros::Duration(common.lifetime);
  marker.ns = ns;
  marker.id = static_cast<int>(id);
  marker.type = type;
  marker.pose.orientation.w = 1.0;
  setVector(scale, &marker.scale);
  marker.color = color;
  return marker;
}

/// A text that faces the viewer, above a place. @param height of its letters [m]
inline visualization_msgs::Marker textAbove(const Common& common,
                                            const std::string& ns,
                                            std::size_t id,
                                            const Eigen::Vector3d& place,
                                            const std::string& words,
                                            const std_msgs::ColorRGBA& color,
                                            double height = kTextHeight) {
  visualization_msgs::Marker text = marker(
      common, ns, id, visualization_msgs::Marker::TEXT_VIEW_FACING, {0.0, 0.0, height}, color);
  text.pose.position = pointOf(place + height * Eigen::Vector3d::UnitZ());
  text.text = words;
  return text;
}

/// Adds a marker that consists of points, or deletes it when it has none.
inline void add(visualization_msgs::Marker marker, visualization_msgs::MarkerArray* array) {
  if (marker.points.empty())
    marker.action = visualization_msgs::Marker::DELETE;
  array->markers.push_back(std::move(marker));
}

}  // namespace wiimote_tracker::markers
