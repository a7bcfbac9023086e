// For tests that a launch file starts, unless they have a main() of their own.
#include <gtest/gtest.h>
#include <ros/ros.h>

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test");  // the launch file names it
  const ros::NodeHandle keeps_ros_running;
  return RUN_ALL_TESTS();
}
