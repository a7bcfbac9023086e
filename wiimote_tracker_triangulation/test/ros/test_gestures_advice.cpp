// A gestures node that sees no end of a gesture says why.
#include <gtest/gtest.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <rosgraph_msgs/Log.h>
#include <wiimote_tracker_msgs/TrackedPointArray.h>

#include <string>

namespace wiimote_tracker {
namespace {

/// Publishes an LED that stays on until the node says something that begins with `words`.
bool isSaid(const std::string& words) {
  ros::NodeHandle nh;
  const ros::Publisher points = nh.advertise<wiimote_tracker_msgs::TrackedPointArray>("points", 10);
  bool is_said = false;
  const ros::Subscriber log = nh.subscribe<rosgraph_msgs::Log>(
      "/rosout", 1000,
      [&](const auto& message) { is_said = is_said || message->msg.find(words) == 0; });
  wiimote_tracker_msgs::TrackedPointArray array;
  array.header.stamp.fromSec(1000.0);
  array.points.resize(1);
  array.points[0].label = "led";
  array.points[0].state = wiimote_tracker_msgs::TrackedPoint::TRACKED;
  const ros::WallTime deadline = ros::WallTime::now() + ros::WallDuration(40.0);
  while (ros::ok() && !is_said && ros::WallTime::now() < deadline) {
    array.header.stamp += ros::Duration(0.01);
    array.points[0].last_observed = array.header.stamp;
    points.publish(array);
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.01));
  }
  return is_said;
}

TEST(ButtonTest, IsNamedWhenNobodyPublishesIt) {
  EXPECT_TRUE(isSaid("Nobody publishes /nobody/joy"));
}

TEST(LightTest, IsNamedWhenItStaysOn) {
  EXPECT_TRUE(isSaid("'led' is on for more than 10 s"));
}

}  // namespace
}  // namespace wiimote_tracker
