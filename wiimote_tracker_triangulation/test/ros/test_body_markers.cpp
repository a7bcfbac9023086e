// What rviz shows of bodies.
#include "geometry/random_rigs.h"
#include "ros/bodies/body_markers.h"
#include "wiimote_tracker_triangulation/ros/message_fields.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>

namespace wiimote_tracker {
namespace {

using Eigen::Vector3d;
using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;
using wiimote_tracker_msgs::TrackedBody;
using wiimote_tracker_msgs::TrackedBodyArray;

/// A wand whose first LED is seen by camera 1 and whose second is hidden.
TrackedBodyArray wand(std::uint8_t state) {
  TrackedBody body;
  body.name = "wand";
  body.state = state;
  body.pose.pose.position = pointOf({1.0, 2.0, 3.0});
  body.pose.pose.orientation.w = body.pose.pose.orientation.z = std::sqrt(0.5);
  body.leds.resize(2);
  body.leds[0].label = "tip";
  body.leds[0].position = pointOf({1.1, 2.0, 3.0});
  body.leds[0].cameras = {"camera_1"};
  body.leds[1].label = "end";
  body.leds[1].position = pointOf({0.9, 2.0, 3.0});
  TrackedBodyArray bodies;
  bodies.header.stamp = ros::Time(100.0);
  bodies.bodies = {body};
  return bodies;
}

class ShownBodies : public testing::Test {
 protected:
  ShownBodies() { markers_.setRig(rig_); }

  void show(const TrackedBodyArray& bodies) { array_ = markers_.build(bodies); }

  Marker find(const std::string& ns, int id) const {
    for (const Marker& marker : array_.markers) {
      if (marker.ns == ns && marker.id == id)
        return marker;
    }
    throw std::logic_error("no marker " + ns + " " + std::to_string(id));
  }

  geometry::test::Random random_{73};
  const geometry::Rig rig_ = geometry::test::randomRig(random_, 3);
  BodyMarkers markers_{20.0};
  MarkerArray array_;
};

TEST_F(ShownBodies, AxesTurnWithTheBody) {
  show(wand(TrackedBody::TRACKED));
  const Marker axes = find("body_axes", 0);
  EXPECT_EQ(wand(TrackedBody::TRACKED).bodies[0].pose.pose, axes.pose);
  ASSERT_EQ(6u, axes.points.size());
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    EXPECT_EQ(Vector3d::Zero(), vectorOf(axes.points[2 * axis]));
    EXPECT_EQ(Vector3d::Unit(axis), vectorOf(axes.points[2 * axis + 1]).normalized());
    const auto& color = axes.colors[2 * axis + 1];  // x red, y green, z blue
    const std::array<float, 3> parts = {color.r, color.g, color.b};
    EXPECT_EQ(axis, std::max_element(parts.begin(), parts.end()) - parts.begin());
  }
}

TEST_F(ShownBodies, LedsHaveTheirNamesAndTheRaysOfTheCamerasThatSeeThem) {
  show(wand(TrackedBody::TRACKED));
  EXPECT_EQ("wand", find("body_label", 0).text);
  EXPECT_EQ("tip", find("body_led_label", 0).text);
  EXPECT_EQ("end", find("body_led_label", 1).text);
  const Marker leds = find("body_led", 0);
  ASSERT_EQ(2u, leds.points.size());
  EXPECT_LT(leds.colors[1].a, leds.colors[0].a) << "what no camera sees is pale";
  const Marker ray = find("body_ray", 0);
  ASSERT_EQ(2u, ray.points.size());
  EXPECT_EQ(rig_.cameras[1].camera.center(), vectorOf(ray.points[0]));
  EXPECT_EQ(Vector3d(1.1, 2.0, 3.0), vectorOf(ray.points[1]));
}

TEST_F(ShownBodies, APredictedBodyIsPaleAndALostOneGoes) {
  show(wand(TrackedBody::TRACKED));
  const Marker tracked = find("body_label", 0);
  EXPECT_GT(tracked.lifetime, ros::Duration(0.0)) << "else rviz keeps a lost body";
  EXPECT_LE(tracked.lifetime, ros::Duration(0.5));
  show(wand(TrackedBody::PREDICTED));
  EXPECT_LT(find("body_label", 0).color.a, tracked.color.a);
  show(wand(TrackedBody::LOST));
  EXPECT_TRUE(array_.markers.empty());
}

TEST_F(ShownBodies, ABodyKeepsItsMarkersWhenAnotherGoes) {
  TrackedBodyArray both = wand(TrackedBody::TRACKED);
  both.bodies.push_back(both.bodies[0]);
  both.bodies[1].name = "cup";
  show(both);
  EXPECT_EQ("cup", find("body_label", 1).text);
  both.bodies.erase(both.bodies.begin());
  show(both);
  EXPECT_EQ("cup", find("body_label", 1).text);
}

TEST_F(ShownBodies, AHiddenBodyHasNoRays) {
  TrackedBodyArray bodies = wand(TrackedBody::PREDICTED);
  bodies.bodies[0].leds[0].cameras.clear();
  show(bodies);
  EXPECT_EQ(Marker::DELETE, find("body_ray", 0).action);
}

}  // namespace
}  // namespace wiimote_tracker
