#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_MARKER_PARTS_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_MARKER_PARTS_H

#include "wiimote_tracker_triangulation/ros/message_fields.h"

#include <std_msgs/ColorRGBA.h>
#include <visualization_msgs/Marker.h>

#include <cstddef>
#include <string>

/// Shared by the markers of LEDs and of bodies.
namespace wiimote_tracker::markers {

constexpr double kLineWidth = 0.01;   // [m]
constexpr double kTextHeight = 0.18;  // [m]

inline std_msgs::ColorRGBA color(float r, float g, float b, float a) {
  std_msgs::ColorRGBA color;
  color.r = r;
  color.g = g;
  color.b = b;
  color.a = a;
  return color;
}

/// @param time stamp [s] @param lifetime after which rviz removes it [s]
inline visualization_msgs::Marker marker(const std::string& frame,
                                         double time,
                                         double lifetime,
                                         const std::string& ns,
                                         std::size_t id,
                                         int type) {
  visualization_msgs::Marker marker;
  marker.header.frame_id = frame;
  marker.header.stamp = timeOf(time);
  marker.ns = ns;
  marker.id = static_cast<int>(id);
  marker.type = type;
  marker.pose.orientation.w = 1.0;
  marker.lifetime = ros::Duration(lifetime);
  return marker;
}

}  // namespace wiimote_tracker::markers

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_MARKER_PARTS_H
