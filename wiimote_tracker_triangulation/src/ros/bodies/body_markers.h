#pragma once

#include "../marker_parts.h"
#include "body/constellation.h"
#include "wiimote_tracker_triangulation/geometry/rig.h"

#include <visualization_msgs/MarkerArray.h>
#include <wiimote_tracker_msgs/TrackedBodyArray.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <map>
#include <string>

namespace wiimote_tracker {

/// Markers of bodies for rviz, in the world frame. Namespaces, with one id per body in the order of
/// appearance: body_axes (x red, y green, z blue), body_shape (lines from the origin to the LEDs),
/// body_led, body_label, body_led_label (LED i: 8 id + i), body_ray (from each camera to the LEDs
/// it sees). Predicted bodies and unseen LEDs are pale.
class BodyMarkers {
  using Marker = visualization_msgs::Marker;
  using BodyLed = wiimote_tracker_msgs::BodyLed;
  using TrackedBody = wiimote_tracker_msgs::TrackedBody;

 public:
  /// @param rate most arrays per second [Hz, > 0].
  explicit BodyMarkers(double rate) : period_(1.0 / rate) {}

  void setRig(const geometry::Rig& rig) { rig_ = rig; }

  /// Whether a period has passed since the last array, or time jumped back.
  bool isDue(double time) const { return time >= time_ + period_ || time < time_; }

  visualization_msgs::MarkerArray build(const wiimote_tracker_msgs::TrackedBodyArray& bodies) {
    time_ = bodies.header.stamp.toSec();
    common_ = {rig_.world_frame, time_, std::max(0.5, 3.0 * period_)};  // lost bodies disappear
    array_.markers.clear();
    for (const TrackedBody& body : bodies.bodies) {
      if (body.state != TrackedBody::LOST)
        addBody(body, ids_.emplace(body.name, ids_.size()).first->second);
    }
    return array_;
  }

 private:
  static constexpr double kAxisLength = 0.15;     // [m]
  static constexpr double kAxisWidth = 0.01;      // [m]
  static constexpr double kLedDiameter = 0.02;    // [m]
  static constexpr double kLedTextHeight = 0.04;  // [m]

  void addBody(const TrackedBody& body, std::size_t id) {
    const float alpha = body.state == TrackedBody::TRACKED ? 1.0f : 0.4f;
    const geometry_msgs::Pose& pose = body.pose.pose;

    Marker axes =
        markers::marker(common_, "body_axes", id, Marker::LINE_LIST, {kAxisWidth, 0.0, 0.0}, {});
    axes.pose = pose;
    for (int axis = 0; axis < 3; ++axis) {
      axes.points.push_back(geometry_msgs::Point());
      axes.points.push_back(pointOf(kAxisLength * Eigen::Vector3d::Unit(axis)));
      axes.colors.insert(axes.colors.end(), 2,
                         markers::color(axis == 0 ? 1.0f : 0.2f, axis == 1 ? 1.0f : 0.2f,
                                        axis == 2 ? 1.0f : 0.2f, alpha));
    }
    array_.markers.push_back(axes);

    Marker shape = markers::marker(common_, "body_shape", id, Marker::LINE_LIST, markers::kLine,
                                   markers::color(0.8f, 0.8f, 0.8f, 0.6f * alpha));
    for (const BodyLed& led : body.leds) {
      shape.points.push_back(pose.position);
      shape.points.push_back(led.position);
    }
    array_.markers.push_back(shape);

    array_.markers.push_back(markers::textAbove(
        common_, "body_label", id, vectorOf(pose.position) + kAxisLength * Eigen::Vector3d::UnitZ(),
        body.name, markers::color(1.0f, 1.0f, 1.0f, alpha)));
    addLeds(body, id);
  }

  void addLeds(const TrackedBody& body, std::size_t id) {
    Marker leds = markers::marker(common_, "body_led", id, Marker::SPHERE_LIST,
                                  Eigen::Vector3d::Constant(kLedDiameter),
                                  markers::color(1.0f, 1.0f, 1.0f, 1.0f));
    Marker rays = markers::marker(common_, "body_ray", id, Marker::LINE_LIST, markers::kLine,
                                  markers::color(0.2f, 1.0f, 0.2f, 0.6f));
    for (std::size_t i = 0; i < body.leds.size(); ++i) {
      const BodyLed& led = body.leds[i];
      const float alpha = led.cameras.empty() ? 0.3f : 1.0f;
      leds.points.push_back(led.position);
      leds.colors.push_back(markers::color(1.0f, 0.4f, 0.3f, alpha));

      array_.markers.push_back(markers::textAbove(
          common_, "body_led_label", body::kMaximumLeds * id + i, vectorOf(led.position), led.label,
          markers::color(1.0f, 0.8f, 0.7f, alpha), kLedTextHeight));

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

  double period_;  // [s]
  geometry::Rig rig_;
  double time_ = -std::numeric_limits<double>::infinity();
  std::map<std::string, std::size_t> ids_;  // by name
  markers::Common common_;
  visualization_msgs::MarkerArray array_;
};

}  // namespace wiimote_tracker
