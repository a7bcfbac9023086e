#include "../src/ros/parameters.h"
#include "../src/ros/file_paths.h"
#include "../src/ros/requests.h"
#include "../src/ros/square_frame.h"

#include "expect_says.h"
#include "run_command.h"

#include <documented_parameters.h>
#include <tf2_eigen/tf2_eigen.h>
#include <wiimote_tracker_msgs/parameter_reader.h>

#include <gtest/gtest.h>
#include <ros/ros.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <utility>

namespace wiimote_tracker {
namespace {

TEST(Parameters, TheFileDocumentsThem) {
  ParameterReader reader(ros::NodeHandle("~nothing"));
  readParameters(&reader);
  expectDocumented(reader, CONFIG_FOLDER "/calibration.yaml");
}

TEST(Parameters, TheFileIsTakenFromTheServer) {
  const ros::NodeHandle nh("~from_file");
  ASSERT_TRUE(nh.hasParam("side_length"));
  const Parameters file = readParameters(ParameterReader(nh));
  EXPECT_TRUE(file.own_intrinsics.empty());
}

// These are not read straight into the options of the libraries.
TEST(Parameters, WordsAndCopiesHaveTheDefaultsOfTheLibraries) {
  const Parameters none = readParameters(ParameterReader(ros::NodeHandle("~nothing")));
  const Parameters fresh;
  EXPECT_EQ(none.cameras, fresh.cameras);
  EXPECT_EQ(none.side_length, fresh.side_length);
  EXPECT_EQ(none.second_side_length, fresh.second_side_length);
  EXPECT_EQ(none.file_folder, fresh.file_folder);
  EXPECT_EQ(none.button_remote, fresh.button_remote);
  EXPECT_EQ(none.continuous_policy, fresh.continuous_policy);
  EXPECT_EQ(none.calibration.hands_free.minimum_cameras,
            fresh.calibration.hands_free.minimum_cameras);
  EXPECT_EQ(none.solve.square.method, fresh.solve.square.method);
  EXPECT_EQ(none.solve.correct_principal_points, fresh.solve.correct_principal_points);
  EXPECT_EQ(none.solve.correction.points, fresh.solve.correction.points);
  EXPECT_EQ(none.solve.ray_model, fresh.solve.ray_model);
  EXPECT_TRUE(std::isnan(none.solve.virtual_hfov));
  EXPECT_EQ(none.intrinsics.distortion_model, fresh.intrinsics.distortion_model);
  EXPECT_EQ(none.intrinsics.distortion, fresh.intrinsics.distortion);
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

TEST(Parameters, OneCameraIsSolvedByThoseOfTheWave) {
  const recalibrate::Options fresh;
  const recalibrate::Options none =
      readParameters(ParameterReader(ros::NodeHandle("~nothing"))).recalibrateOptions();
  EXPECT_EQ(none.pixel, fresh.pixel);
  EXPECT_EQ(none.wander, fresh.wander);
  EXPECT_EQ(none.maximum_offset_stddev, fresh.maximum_offset_stddev);
  const recalibrate::Options noisy =
      readParameters(ParameterReader(ros::NodeHandle("~noisy"))).recalibrateOptions();
  EXPECT_EQ(noisy.uncertainty.k1, 0.1);
  EXPECT_EQ(noisy.pixel, 2.0);
  EXPECT_EQ(noisy.wander, 0.001);
  EXPECT_EQ(noisy.maximum_offset_stddev, 0.002);
}

TEST(Parameters, RelativeFilesLieBesideTheRigFileOrWhereTheyArePermitted) {
  Parameters parameters;
  parameters.rig_file = "/tmp/rigs/rig.yaml";
  EXPECT_EQ(rigPath("", parameters), "/tmp/rigs/rig.yaml");
  EXPECT_EQ(rigPath("old.yaml", parameters), "/tmp/rigs/old.yaml");
  EXPECT_EQ(rigPath("/tmp/rigs/old.yaml", parameters), "/tmp/rigs/old.yaml");
  EXPECT_EQ(samplesPath("old/samples.yaml", parameters), "/tmp/rigs/old/samples.yaml");
  for (const char* outside : {"../old.yaml", "/tmp/old.yaml", "~/rig.yaml"})
    EXPECT_THROW(rigPath(outside, parameters), Refusal) << outside;
  parameters.file_folder = "/";
  EXPECT_EQ(rigPath("old.yaml", parameters), "/tmp/rigs/old.yaml");
  EXPECT_EQ(rigPath("/home/rig.yaml", parameters), "/home/rig.yaml");
  parameters.file_folder = "/tmp/others/";
  EXPECT_EQ(rigPath("old.yaml", parameters), "/tmp/others/old.yaml");
  EXPECT_THROW(rigPath("/tmp/rigs/old.yaml", parameters), Refusal);
}

TEST(Parameters, AMissingRigFileIsNamedByItsFullPath) {
  const std::string here = std::filesystem::current_path().string();
  EXPECT_SAYS(describeMissingRig("no/rig.yaml"), "no file " + here + "/no/rig.yaml, so");
  EXPECT_EQ(describeMissingRig(here), "");
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
  const std::pair<std::string, std::string> cases[] = {
      {"short", "intrinsics/distortion must"},   {"word", "method is 'best'"},
      {"period", "diagnostic_period is 0"},      {"slash", "world_frame is /world, but"},
      {"mounted", "button_remote is wiimote_2"}, {"fisheye", "intrinsics/distortion must"}};
  for (const auto& [key, what] : cases) {
    try {
      readParameters(ParameterReader(ros::NodeHandle("~" + key)));
      FAIL() << key;
    } catch (const ParameterError& error) {
      EXPECT_SAYS(std::string(error.what()), "/parameters_test/" + key + "/" + what);
    }
  }
}

/// Exit status and output of a node that is to end by itself.
std::pair<int, std::string> outcomeOf(const std::string& environment,
                                      const std::string& arguments) {
  return runCommand(environment +
                    " timeout 60 rosrun wiimote_tracker_calibration calibration_node "
                    "__ns:=/refused " +
                    arguments);
}

TEST(Parameters, ThatAreBadOrAMissingMasterEndTheNodeWithASentence) {
  auto outcome = outcomeOf("", "_side_lenght:=2.5");
  EXPECT_EQ(outcome.first, 1);
  EXPECT_SAYS(outcome.second, "/refused/calibration/side_lenght");
  outcome = outcomeOf("", "_side_length:=-1.0 _side_lenght:=2.5");
  EXPECT_EQ(outcome.first, 1);
  EXPECT_SAYS(outcome.second, "/refused/calibration/side_length");
  outcome = outcomeOf("ROS_MASTER_URI=http://localhost:9", "");
  EXPECT_EQ(outcome.first, 1);
  EXPECT_SAYS(outcome.second, "no ROS master at http://localhost:9");
}

}  // namespace
}  // namespace wiimote_tracker

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "parameters_test");
  const ros::NodeHandle nh;
  return RUN_ALL_TESTS();
}
