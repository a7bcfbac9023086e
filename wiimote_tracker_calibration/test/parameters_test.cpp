#include "../src/ros/parameters.h"

#include <wiimote_tracker_msgs/parameter_reader.h>

#include <gtest/gtest.h>
#include <ros/ros.h>

namespace wiimote_tracker {
namespace {

void expectSame(const geometry::Intrinsics& a, const geometry::Intrinsics& b) {
  EXPECT_EQ(a.width, b.width);
  EXPECT_EQ(a.height, b.height);
  EXPECT_EQ(a.fx, b.fx);
  EXPECT_EQ(a.fy, b.fy);
  EXPECT_EQ(a.cx, b.cx);
  EXPECT_EQ(a.cy, b.cy);
  EXPECT_EQ(a.distortion, b.distortion);
}

TEST(Parameters, the_file_says_what_the_defaults_are) {
  const Parameters file = readParameters(ros::NodeHandle("~from_file"));
  const Parameters none = readParameters(ros::NodeHandle("~nothing"));
  EXPECT_EQ(file.cameras, none.cameras);
  EXPECT_EQ(file.side_length, none.side_length);
  EXPECT_EQ(file.second_side_length, none.second_side_length);
  EXPECT_EQ(file.rig_file, none.rig_file);
  EXPECT_EQ(file.use_gravity, none.use_gravity);
  expectSame(file.intrinsics, none.intrinsics);
  expectSame(none.intrinsics, geometry::Intrinsics());
  EXPECT_TRUE(file.own_intrinsics.empty());

  const workflow::CalibrationOptions& a = file.calibration;
  const workflow::CalibrationOptions b;
  EXPECT_EQ(a.capture.minimum_samples, b.capture.minimum_samples);
  EXPECT_EQ(a.capture.minimum_cameras, b.capture.minimum_cameras);
  EXPECT_EQ(a.capture.spread_limit, b.capture.spread_limit);
  EXPECT_EQ(a.capture.drift_limit, b.capture.drift_limit);
  EXPECT_EQ(a.capture.timeout, b.capture.timeout);
  EXPECT_EQ(a.solve.method, b.solve.method);
  EXPECT_EQ(a.solve.branch_odds, b.solve.branch_odds);
  const square::Uncertainty& u = a.solve.uncertainty;
  const square::Uncertainty v;
  EXPECT_EQ(u.pixel, v.pixel);
  EXPECT_EQ(u.placement, v.placement);
  EXPECT_EQ(u.focal, v.focal);
  EXPECT_EQ(u.aspect, v.aspect);
  EXPECT_EQ(u.principal_point, v.principal_point);
  EXPECT_EQ(u.k1, v.k1);
  EXPECT_EQ(u.gravity, v.gravity);
  EXPECT_EQ(a.led_height, b.led_height);
  EXPECT_EQ(a.origin, b.origin);
  EXPECT_EQ(a.yaw, b.yaw);
  EXPECT_EQ(a.world_frame, b.world_frame);
}

TEST(Parameters, single_cameras_can_have_their_own_intrinsics) {
  const Parameters own = readParameters(ros::NodeHandle("~own"));
  EXPECT_EQ(own.intrinsicsOf("wiimote_1").fx, 1298.0);
  EXPECT_EQ(own.intrinsicsOf("wiimote_1").width, 640);
  EXPECT_EQ(own.intrinsicsOf("wiimote_1").fy, 1302.3);
  EXPECT_EQ(own.intrinsicsOf("hall/wiimote_2").distortion[0], 0.1);
  EXPECT_EQ(own.intrinsicsOf("another").fx, 1306.3);
}

TEST(Parameters, bad_values_are_refused_by_name) {
  for (const std::string key : {"short", "word"}) {
    try {
      readParameters(ros::NodeHandle("~" + key));
      FAIL() << key;
    } catch (const ParameterError& error) {
      EXPECT_NE(std::string(error.what()).find("/parameters_test/" + key), std::string::npos)
          << error.what();
    }
  }
}

}  // namespace
}  // namespace wiimote_tracker

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "parameters_test");
  const ros::NodeHandle nh;
  return RUN_ALL_TESTS();
}
