#include "body_markers.h"

#include "../marker_parts.h"
#include "body/constellation.h"

#include <algorithm>

namespace wiimote_tracker {
namespace {

using markers::color;
using markers::kLine;
using markers::kTextHeight;
using visualization_msgs::Marker;
using wiimote_tracker_msgs::BodyLed;
using wiimote_tracker_msgs::TrackedBody;

constexpr double kAxisLength = 0.15;     // [m]
constexpr double kAxisWidth = 0.01;      // [m]
constexpr double kLedDiameter = 0.02;    // [m]
constexpr double kLedTextHeight = 0.04;  // [m]

geometry_msgs::Point above(geometry_msgs::Point point, double height) {
  point.z += height;
  return point;
}

}  // namespace

visualization_msgs::MarkerArray BodyMarkers::build(
    const wiimote_tracker_msgs::TrackedBodyArray& bodies) {
  time_ = bodies.header.stamp.toSec();
  common_ = {rig_.world_frame, time_, std::max(0.5, 3.0 * period_)};  // lost bodies disappear
  array_.markers.clear();
  for (const TrackedBody& body : bodies.bodies) {
    if (body.state != TrackedBody::LOST)
      addBody(body, ids_.emplace(body.name, ids_.size()).first->second);
  }
  return array_;
}

void BodyMarkers::addBody(const TrackedBody& body, std::size_t id) {
  const float alpha = body.state == TrackedBody::TRACKED ? 1.0f : 0.4f;
  const geometry_msgs::Pose& pose = body.pose.pose;

  Marker axes =
      markers::marker(common_, "body_axes", id, Marker::LINE_LIST, {kAxisWidth, 0.0, 0.0}, {});
  axes.pose = pose;
  for (int axis = 0; axis < 3; ++axis) {
    axes.points.push_back(geometry_msgs::Point());
    axes.points.push_back(pointOf(kAxisLength * Eigen::Vector3d::Unit(axis)));
    axes.colors.insert(
        axes.colors.end(), 2,
        color(axis == 0 ? 1.0f : 0.2f, axis == 1 ? 1.0f : 0.2f, axis == 2 ? 1.0f : 0.2f, alpha));
  }
  array_.markers.push_back(axes);

  Marker shape = markers::marker(common_, "body_shape", id, Marker::LINE_LIST, kLine,
                                 color(0.8f, 0.8f, 0.8f, 0.6f * alpha));
  for (const BodyLed& led : body.leds) {
    shape.points.push_back(pose.position);
    shape.points.push_back(led.position);
  }
  array_.markers.push_back(shape);

  array_.markers.push_back(markers::text(common_, "body_label", id,
                                         above(pose.position, kAxisLength + kTextHeight), body.name,
                                         color(1.0f, 1.0f, 1.0f, alpha)));
  addLeds(body, id);
}

void BodyMarkers::addLeds(const TrackedBody& body, std::size_t id) {
  Marker leds =
      markers::marker(common_, "body_led", id, Marker::SPHERE_LIST,
                      Eigen::Vector3d::Constant(kLedDiameter), color(1.0f, 1.0f, 1.0f, 1.0f));
  Marker rays = markers::marker(common_, "body_ray", id, Marker::LINE_LIST, kLine,
                                color(0.2f, 1.0f, 0.2f, 0.6f));
  for (std::size_t i = 0; i < body.leds.size(); ++i) {
    const BodyLed& led = body.leds[i];
    const float alpha = led.cameras.empty() ? 0.3f : 1.0f;
    leds.points.push_back(led.position);
    leds.colors.push_back(color(1.0f, 0.4f, 0.3f, alpha));

    array_.markers.push_back(markers::text(common_, "body_led_label", body::kMaximumLeds * id + i,
                                           above(led.position, kLedTextHeight), led.label,
                                           color(1.0f, 0.8f, 0.7f, alpha), kLedTextHeight));

    for (const geometry::RigCamera& camera : rig_.cameras) {
      const std::string& name = camera.camera.name;
      if (std::find(led.cameras.begin(), led.cameras.end(), name) == led.cameras.end())
        continue;
      rays.points.push_back(pointOf(camera.camera.center()));
      rays.points.push_back(led.position);
    }
  }
  array_.markers.push_back(leds);
  markers::add(rays, &array_);
}

}  // namespace wiimote_tracker
