// Runs the tests of the calibration node that a launch file chooses.

#include <gtest/gtest.h>
#include <ros/ros.h>

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "calibration_node_tests");
  ros::AsyncSpinner spinner(8);  // thrown_errors.test runs the node in this process
  spinner.start();
  const int result = RUN_ALL_TESTS();
  // A filter that fits no test is a mistake.
  return testing::UnitTest::GetInstance()->test_to_run_count() == 0 ? 1 : result;
}
