#include "body_markers.h"

#include "../marker_parts.h"
#include "wiimote_tracker_triangulation/body/constellation.h"

#include <algorithm>

namespace wiimote_tracker {
namespace {

using markers::color;
using markers::kLineWidth;
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
  array_.markers.clear();
  for (const TrackedBody& body : bodies.bodies) {
    if (body.state != TrackedBody::LOST)
      addBody(body, ids_.emplace(body.name, ids_.size()).first->second);
  }
  return array_;
}

Marker BodyMarkers::marker(const std::string& ns, std::size_t id, int type) const {
  // So that lost bodies disappear.
  const double lifetime = std::max(0.5, 3.0 * period_);
  return markers::marker(rig_.world_frame, time_, lifetime, ns, id, type);
}

void BodyMarkers::addBody(const TrackedBody& body, std::size_t id) {
  const float alpha = body.state == TrackedBody::TRACKED ? 1.0f : 0.4f;
  const geometry_msgs::Pose& pose = body.pose.pose;

  Marker axes = marker("body_axes", id, Marker::LINE_LIST);
  axes.pose = pose;
  axes.scale.x = kAxisWidth;
  for (int axis = 0; axis < 3; ++axis) {
    axes.points.push_back(geometry_msgs::Point());
    axes.points.push_back(pointOf(kAxisLength * Eigen::Vector3d::Unit(axis)));
    axes.colors.insert(
        axes.colors.end(), 2,
        color(axis == 0 ? 1.0f : 0.2f, axis == 1 ? 1.0f : 0.2f, axis == 2 ? 1.0f : 0.2f, alpha));
  }
  array_.markers.push_back(axes);

  Marker shape = marker("body_shape", id, Marker::LINE_LIST);
  shape.scale.x = kLineWidth;
  shape.color = color(0.8f, 0.8f, 0.8f, 0.6f * alpha);
  for (const BodyLed& led : body.leds) {
    shape.points.push_back(pose.position);
    shape.points.push_back(led.position);
  }
  array_.markers.push_back(shape);

  Marker name = marker("body_label", id, Marker::TEXT_VIEW_FACING);
  name.pose.position = above(pose.position, kAxisLength + kTextHeight);
  name.text = body.name;
  name.scale.z = kTextHeight;
  name.color = color(1.0f, 1.0f, 1.0f, alpha);
  array_.markers.push_back(name);
  addLeds(body, id);
}

void BodyMarkers::addLeds(const TrackedBody& body, std::size_t id) {
  Marker leds = marker("body_led", id, Marker::SPHERE_LIST);
  leds.scale.x = leds.scale.y = leds.scale.z = kLedDiameter;
  leds.color = color(1.0f, 1.0f, 1.0f, 1.0f);
  Marker rays = marker("body_ray", id, Marker::LINE_LIST);
  rays.scale.x = kLineWidth;
  rays.color = color(0.2f, 1.0f, 0.2f, 0.6f);
  for (std::size_t i = 0; i < body.leds.size(); ++i) {
    const BodyLed& led = body.leds[i];
    const float alpha = led.cameras.empty() ? 0.3f : 1.0f;
    leds.points.push_back(led.position);
    leds.colors.push_back(color(1.0f, 0.4f, 0.3f, alpha));

    Marker label = marker("body_led_label", body::kMaximumLeds * id + i, Marker::TEXT_VIEW_FACING);
    label.pose.position = above(led.position, kLedTextHeight);
    label.text = led.label;
    label.scale.z = kLedTextHeight;
    label.color = color(1.0f, 0.8f, 0.7f, alpha);
    array_.markers.push_back(label);

    for (const geometry::RigCamera& camera : rig_.cameras) {
      const std::string& name = camera.camera.name;
      if (std::find(led.cameras.begin(), led.cameras.end(), name) == led.cameras.end())
        continue;
      rays.points.push_back(pointOf(camera.camera.center()));
      rays.points.push_back(led.position);
    }
  }
  array_.markers.push_back(leds);
  if (rays.points.empty())
    rays.action = Marker::DELETE;
  array_.markers.push_back(rays);
}

}  // namespace wiimote_tracker
