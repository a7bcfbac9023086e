// The shipped YAML and the defaults in the code say the same; what is wrong is refused by name.
#include "parameters.h"

#include <gtest/gtest.h>
#include <wiimote_tracker_msgs/parameter_reader.h>

#include <algorithm>

namespace wiimote_tracker {
namespace {

TEST(Parameters, ShippedFileHoldsTheDefaults) {
  const ros::NodeHandle nh("~shipped");
  for (const char* key : {"label", "method", "pixel_stddev", "minimum_angle",
                          "maximum_reprojection_error", "camera_timeout", "maximum_gap",
                          "markers/rate", "markers/image_plane_distance", "markers/trail_duration"})
    EXPECT_TRUE(nh.hasParam(key)) << key;
  const TriangulationParameters defaults;
  const TriangulationParameters read = TriangulationParameters::read(nh);
  EXPECT_EQ(defaults.label, read.label);
  EXPECT_EQ(defaults.fuser.triangulation.method, read.fuser.triangulation.method);
  EXPECT_EQ(defaults.fuser.triangulation.pixel_stddev, read.fuser.triangulation.pixel_stddev);
  EXPECT_EQ(defaults.fuser.triangulation.minimum_angle, read.fuser.triangulation.minimum_angle);
  EXPECT_EQ(defaults.fuser.maximum_reprojection_error, read.fuser.maximum_reprojection_error);
  EXPECT_EQ(defaults.fuser.camera_timeout, read.fuser.camera_timeout);
  EXPECT_EQ(defaults.fuser.maximum_gap, read.fuser.maximum_gap);
  EXPECT_EQ(defaults.markers.rate, read.markers.rate);
  EXPECT_EQ(defaults.markers.image_plane_distance, read.markers.image_plane_distance);
  EXPECT_EQ(defaults.markers.trail_duration, read.markers.trail_duration);
}

TEST(Parameters, EveryMethodHasItsWord) {
  EXPECT_EQ("mean_closest", methodName(geometry::TriangulationMethod::kMeanClosest));
  EXPECT_EQ("least_squares", methodName(geometry::TriangulationMethod::kLeastSquares));
  EXPECT_EQ("maximum_likelihood", methodName(geometry::TriangulationMethod::kMaximumLikelihood));
  const ros::NodeHandle nh("~paper");
  EXPECT_EQ(geometry::TriangulationMethod::kMeanClosest,
            TriangulationParameters::read(nh).fuser.triangulation.method);
}

TEST(Parameters, WhatIsWrongIsNamedInFull) {
  for (const std::string key :
       {"label", "method", "pixel_stddev", "minimum_angle", "maximum_reprojection_error",
        "camera_timeout", "maximum_gap", "markers/rate", "markers/trail_duration", "misspelt"}) {
    std::string group = key;
    std::replace(group.begin(), group.end(), '/', '_');
    const ros::NodeHandle nh("~wrong_" + group);
    try {
      TriangulationParameters::read(nh);
      ADD_FAILURE() << key << " was taken";
    } catch (const ParameterError& e) {
      EXPECT_NE(std::string::npos, std::string(e.what()).find(nh.resolveName(key))) << e.what();
    }
  }
}

}  // namespace
}  // namespace wiimote_tracker

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test_parameters");
  return RUN_ALL_TESTS();
}
