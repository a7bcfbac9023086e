#include "../src/ros/parameters.h"
#include "../src/ros/square_frame.h"

#include <tf2_eigen/tf2_eigen.h>
#include <wiimote_tracker_msgs/parameter_reader.h>

#include <gtest/gtest.h>
#include <ros/ros.h>

#include <cmath>

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

TEST(Parameters, TheFileSaysWhatTheDefaultsAre) {
  const Parameters file = readParameters(ParameterReader(ros::NodeHandle("~from_file")));
  const Parameters none = readParameters(ParameterReader(ros::NodeHandle("~nothing")));
  EXPECT_EQ(file.cameras, none.cameras);
  EXPECT_EQ(file.side_length, none.side_length);
  EXPECT_EQ(file.second_side_length, none.second_side_length);
  EXPECT_EQ(file.rig_file, none.rig_file);
  EXPECT_EQ(file.set_camera_info_timeout, none.set_camera_info_timeout);
  EXPECT_EQ(file.hands_free, none.hands_free);
  EXPECT_EQ(file.sounds, none.sounds);
  EXPECT_EQ(file.button_remote, none.button_remote);
  EXPECT_EQ(file.masks.share, capture::MaskOptions().share);
  EXPECT_EQ(file.masks.margin, capture::MaskOptions().margin);
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
  EXPECT_EQ(a.hands_free.hold, b.hands_free.hold);
  EXPECT_EQ(a.hands_free.distance, b.hands_free.distance);
  EXPECT_EQ(a.hands_free.minimum_cameras, b.hands_free.minimum_cameras);
  EXPECT_EQ(a.coverage.seconds, b.coverage.seconds);
  EXPECT_EQ(a.coverage.image_share, b.coverage.image_share);
  EXPECT_EQ(a.coverage.image_speed, b.coverage.image_speed);
  EXPECT_EQ(a.coverage.volume, b.coverage.volume);
  EXPECT_EQ(a.coverage.speed, b.coverage.speed);
  EXPECT_EQ(a.coverage.distraction, b.coverage.distraction);
  const session::SolveOptions& s = file.solve;
  const session::SolveOptions t;
  EXPECT_EQ(s.use_gravity, t.use_gravity);
  EXPECT_EQ(s.wave.pixel, t.wave.pixel);
  EXPECT_EQ(s.wave.stamp, t.wave.stamp);
  EXPECT_EQ(s.wave.wander, t.wave.wander);
  EXPECT_EQ(s.wave.offset, t.wave.offset);
  EXPECT_EQ(s.wave.knot_spacing, t.wave.knot_spacing);
  EXPECT_EQ(s.wave.acceleration, t.wave.acceleration);
  EXPECT_EQ(s.wave.maximum_offset_stddev, t.wave.maximum_offset_stddev);
  EXPECT_EQ(s.correct_principal_points, t.correct_principal_points);
  EXPECT_EQ(s.correction.points, t.correction.points);
  EXPECT_EQ(s.correction.rounds, t.correction.rounds);
  EXPECT_EQ(s.correction.limit, t.correction.limit);
  EXPECT_EQ(s.ray_model, t.ray_model);
  EXPECT_TRUE(std::isnan(s.virtual_hfov));
  EXPECT_EQ(s.square.method, t.square.method);
  EXPECT_EQ(s.square.branch_odds, t.square.branch_odds);
  const square::Uncertainty& u = s.square.uncertainty;
  const square::Uncertainty v;
  EXPECT_EQ(u.pixel, v.pixel);
  EXPECT_EQ(u.placement, v.placement);
  EXPECT_EQ(u.focal, v.focal);
  EXPECT_EQ(u.aspect, v.aspect);
  EXPECT_EQ(u.principal_point, v.principal_point);
  EXPECT_EQ(u.shared_principal_point, v.shared_principal_point);
  EXPECT_EQ(u.k1, v.k1);
  EXPECT_EQ(u.gravity, v.gravity);
  EXPECT_EQ(a.led_height, b.led_height);
  EXPECT_EQ(a.origin, b.origin);
  EXPECT_EQ(a.yaw, b.yaw);
  EXPECT_EQ(a.world_frame, b.world_frame);
}

TEST(Parameters, SingleCamerasCanHaveTheirOwnIntrinsics) {
  const Parameters own = readParameters(ParameterReader(ros::NodeHandle("~own")));
  EXPECT_EQ(own.intrinsicsOf("wiimote_1").fx, 1298.0);
  EXPECT_EQ(own.intrinsicsOf("wiimote_1").width, 640);
  EXPECT_EQ(own.intrinsicsOf("wiimote_1").fy, 1302.3);
  EXPECT_EQ(own.intrinsicsOf("hall/wiimote_2").distortion[0], 0.1);
  EXPECT_EQ(own.intrinsicsOf("another").fx, 1306.3);
  const geometry::Intrinsics& fisheye = own.intrinsicsOf("wiimote_3");
  EXPECT_EQ(fisheye.distortion_model, geometry::DistortionModel::kEquidistant);
  EXPECT_EQ(fisheye.distortion[3], 0.4);
  EXPECT_EQ(fisheye.distortion[4], 0.0);
}

TEST(Parameters, WhatThePaperDoesCanBeChosen) {
  const Parameters paper = readParameters(ParameterReader(ros::NodeHandle("~paper")));
  EXPECT_EQ(paper.solve.square.method, square::Method::kPerCamera);
  EXPECT_TRUE(paper.solve.correct_principal_points);
  EXPECT_EQ(paper.solve.correction.points, principal_point::Points::kAllCorners);
  EXPECT_EQ(paper.solve.ray_model, geometry::RayModel::kImageCenter);
  EXPECT_EQ(paper.solve.virtual_hfov, 0.7156);
}

TEST(Parameters, TheSquareIsWhereTheSolverPutsIt) {
  square::SquareLayout layout;
  layout.side_x = 2.5;
  layout.side_y = 2.0;
  layout.led_height = 0.1;
  layout.origin = {1.0, 0.5};
  layout.yaw = 0.3;
  geometry::Rig rig;
  layout.describeIn(&rig);
  const auto outline = squareOutline("world", squareOf(rig));
  EXPECT_EQ(outline.header.frame_id, "world");
  const Eigen::Isometry3d world_from_square =
      tf2::transformToEigen(squareTransform("world", layout));
  const Eigen::Vector3d in_square[] = {{0, 0, 0}, {2.5, 0, 0}, {2.5, 2, 0}, {0, 2, 0}};
  for (std::size_t i = 0; i < 4; ++i) {
    const geometry_msgs::Point32& corner = outline.polygon.points.at(i);
    const Eigen::Vector3d in_world(corner.x, corner.y, corner.z);
    EXPECT_LT((world_from_square * in_square[i] - in_world).norm(), 1e-6);
    EXPECT_LT((layout.corners(true)[i].head<2>() - in_world.head<2>()).norm(), 1e-6);
  }
  rig.square_pose.reset();  // a file of an earlier version
  EXPECT_TRUE(squareOutline("world", squareOf(rig)).polygon.points.empty());
}

TEST(Parameters, BadValuesAreRefusedByName) {
  for (const std::string key : {"short", "word", "mounted", "fisheye"}) {
    try {
      readParameters(ParameterReader(ros::NodeHandle("~" + key)));
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
