// A gestures node whose button nobody publishes.
#include <gtest/gtest.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <rosgraph_msgs/Log.h>
#include <wiimote_tracker_msgs/TrackedPointArray.h>

namespace wiimote_tracker {
namespace {

TEST(ButtonTest, IsNamedWhenNobodyPublishesIt) {
  ros::NodeHandle nh;
  const ros::Publisher points = nh.advertise<wiimote_tracker_msgs::TrackedPointArray>("points", 10);
  bool is_named = false;
  const ros::Subscriber log =
      nh.subscribe<rosgraph_msgs::Log>("/rosout", 1000, [&](const auto& message) {
        is_named = is_named || message->msg.find("Nobody publishes /nobody/joy") == 0;
      });
  wiimote_tracker_msgs::TrackedPointArray array;
  array.header.stamp.fromSec(1000.0);
  const ros::WallTime deadline = ros::WallTime::now() + ros::WallDuration(40.0);
  while (ros::ok() && !is_named && ros::WallTime::now() < deadline) {
    array.header.stamp += ros::Duration(0.01);
    points.publish(array);
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.01));
  }
  EXPECT_TRUE(is_named);
}

}  // namespace
}  // namespace wiimote_tracker
