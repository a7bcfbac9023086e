// The shipped YAML equals the defaults in the code; wrong values are refused by name.
#include "ros/coverage/coverage_display.h"
#include "ros/gestures/gesture_parameters.h"
#include "ros/tracker/parameters.h"
#include "wiimote_tracker_triangulation/ros/parameter_file.h"

#include <documented_parameters.h>
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <wiimote_tracker_msgs/parameter_reader.h>

#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <map>
#include <string>
#include <vector>

namespace wiimote_tracker {
namespace {

TrackingParameters read(const ros::NodeHandle& nh) {
  return TrackingParameters::read(ParameterReader(nh));
}

TEST(Parameters, ShippedFileHoldsTheDefaults) {
  ParameterReader reader(readParameterTree("", "triangulation"));
  TrackingParameters::read(&reader);
  expectDocumented(reader, CONFIG_FOLDER "/triangulation.yaml");
  EXPECT_NO_THROW(read(ros::NodeHandle("~shipped"))) << "from the parameter server";
}

TEST(GestureParameters, ShippedFileHoldsTheDefaults) {
  ParameterReader reader(readParameterTree("", "triangulation"));
  GestureParameters::read(&reader);
  expectDocumented(reader, CONFIG_FOLDER "/gestures.yaml");
}

TEST(CoverageParameters, ShippedFileHoldsTheDefaults) {
  ParameterReader reader(readParameterTree("", "triangulation"));
  EXPECT_FALSE(CoverageParameters::read(&reader).volume);
  expectDocumented(reader, CONFIG_FOLDER "/coverage.yaml");
}

TEST(Parameters, EveryNumberIsReadAndBounded) {
  ParameterReader defaults(readParameterTree("", "triangulation"));
  TrackingParameters::read(&defaults);
  EXPECT_FALSE(defaults.ranges().empty());
  for (const auto& [key, range] : defaults.ranges()) {
    ros::NodeHandle nh("~bounded");
    // Below every range, and an integer, as some parameters require.
    nh.setParam(key, -1000000000);
    try {
      read(nh);
      ADD_FAILURE() << key << " was taken";
    } catch (const ParameterError& e) {
      EXPECT_NE(std::string::npos, std::string(e.what()).find(nh.resolveName(key) + " is"))
          << e.what();
    }
    nh.deleteParam("");
  }
}

TEST(Parameters, SetValuesAreRead) {
  ros::NodeHandle nh("~set");
  nh.setParam("labels", std::vector<std::string>{"left", "right_hand"});
  nh.setParam("mode", "instant");
  nh.setParam("instant/method", "mean_closest");
  nh.setParam("pixel_stddev", 0.25);
  nh.setParam("tracks/minimum_corner", std::vector<double>{-1.0, -2.0, 0.5});
  nh.setParam("tracks/confirmation_hits", 3);
  nh.setParam("output/on_update", false);
  nh.setParam("output/rate", 30);
  nh.setParam("output/publish_predicted", true);
  nh.setParam("output/led_odometry", true);
  nh.setParam("output/body_transforms", false);
  const TrackingParameters p = read(nh);
  EXPECT_EQ((std::vector<std::string>{"left", "right_hand"}), p.labels);
  EXPECT_EQ(estimators::TrackerMode::kInstant, p.estimator.tracker_mode);
  EXPECT_EQ("mean_closest", methodWord(p.estimator));
  EXPECT_EQ(0.25, p.estimator.tracks.pixel_stddev);
  EXPECT_EQ(0.25, p.estimator.instant.triangulation.pixel_stddev);
  EXPECT_EQ(Eigen::Vector3d(-1.0, -2.0, 0.5), p.estimator.tracks.minimum_corner);
  EXPECT_EQ(3u, p.estimator.tracks.confirmation_hits);
  EXPECT_FALSE(p.output.on_update);
  EXPECT_EQ(30.0, p.output.rate);
  EXPECT_TRUE(p.output.publish_predicted);
  EXPECT_TRUE(p.output.led_odometry);
  EXPECT_FALSE(p.output.body_transforms);
}

TEST(Parameters, OfAFileAreTypedAsByRosparam) {
  const std::string path = testing::TempDir() + "typed_" + std::to_string(::getpid()) + ".yaml";
  std::ofstream(path) << "labels: [x, y, n]\noutput: {led_odometry: yes, rate: 30}\n";
  const TrackingParameters p =
      TrackingParameters::read(ParameterReader(readParameterTree(path, "triangulation")));
  std::remove(path.c_str());
  EXPECT_EQ((std::vector<std::string>{"x", "y", "n"}), p.labels);
  EXPECT_TRUE(p.output.led_odometry);
  EXPECT_EQ(30.0, p.output.rate);
}

TEST(Parameters, BlinkCodesSetTheTrackersOptions) {
  ros::NodeHandle nh("~blinking");
  nh.setParam("identity/codes", CONFIG_FOLDER "/blink_codes_paper.yaml");
  const TrackingParameters p = read(nh);
  ASSERT_TRUE(p.identity.codes);
  EXPECT_EQ((std::vector<std::string>{"led", "left_hand", "right_hand", "head", "back"}),
            p.allLabels());
  const tracking::TrackerOptions plain;
  EXPECT_EQ(p.identity.codes->longestDark(), p.estimator.tracks.dark_time);
  EXPECT_EQ(2.0 * p.identity.codes->longestDark(), p.estimator.tracks.prediction_time);
  EXPECT_NEAR((0.9 + 0.6 + 0.4 + 0.2) / 4 * plain.detection_probability,
              p.estimator.tracks.detection_probability, 1e-12);
  EXPECT_NE(std::string::npos, describeIdentity(p).find("tracks/prediction_time 0.8 s"));
  EXPECT_TRUE(describeIdentity(TrackingParameters()).empty());
}

TEST(Parameters, EveryMethodHasAName) {
  using geometry::TriangulationMethod;
  estimators::EstimatorOptions options;
  EXPECT_EQ("track", methodWord(options));
  options.tracker_mode = estimators::TrackerMode::kInstant;
  for (const auto& [method, word] : std::map<TriangulationMethod, std::string>{
           {TriangulationMethod::kMeanClosest, "mean_closest"},
           {TriangulationMethod::kLeastSquares, "least_squares"},
           {TriangulationMethod::kMaximumLikelihood, "maximum_likelihood"},
           {TriangulationMethod::kReweightedMidpoint, "reweighted_midpoint"}}) {
    options.instant.triangulation.method = method;
    EXPECT_EQ(word, methodWord(options));
    ros::NodeHandle nh("~method");
    nh.setParam("instant/method", word);
    EXPECT_EQ(method, read(nh).estimator.instant.triangulation.method);
  }
}

TEST(Parameters, WrongValuesAreNamedByTheirFullKey) {
  const auto refuses = [](const std::string& key, const XmlRpc::XmlRpcValue& value) {
    ros::NodeHandle nh("~wrong");
    nh.setParam(key, value);
    std::string complaint = "taken";
    try {
      read(nh);
    } catch (const ParameterError& e) {
      complaint = e.what();
    }
    nh.deleteParam("");
    return complaint.find(nh.resolveName(key)) != std::string::npos;
  };
  const auto list = [](const std::vector<std::string>& words) {
    XmlRpc::XmlRpcValue value;
    value.setSize(static_cast<int>(words.size()));
    for (std::size_t i = 0; i < words.size(); ++i)
      value[static_cast<int>(i)] = words[i];
    return value;
  };
  EXPECT_TRUE(refuses("labels", list({"two words"})));
  EXPECT_TRUE(refuses("labels", list({"led", "led"})));
  EXPECT_TRUE(refuses("labels", list({"led_7"}))) << "that name is taken by the seventh track";
  EXPECT_TRUE(refuses("labels", "led"));
  EXPECT_TRUE(refuses("mode", "guess"));
  EXPECT_TRUE(refuses("instant/method", "guess"));
  EXPECT_TRUE(refuses("instant/maximum_gap", 0.2)) << "beyond the camera time-out";
  EXPECT_TRUE(refuses("tracks/minimum_corner", list({"1"})));
  EXPECT_TRUE(refuses("tracks/confirmation_hits", 2.5)) << "not rounded";
  EXPECT_TRUE(refuses("diagnostic_period", 0));
  EXPECT_TRUE(refuses("output/on_update", false)) << "nothing would go out";
  EXPECT_TRUE(refuses("identity/codes", "/nowhere/codes.yaml"));
  EXPECT_TRUE(refuses("misspelt", 1));
  EXPECT_TRUE(refuses("label", "led")) << "there may be several";

  ros::NodeHandle blinking("~blinking_instants");
  blinking.setParam("identity/codes", CONFIG_FOLDER "/blink_codes.yaml");
  blinking.setParam("labels", std::vector<std::string>{"head"});
  EXPECT_THROW(read(blinking), ParameterError) << "two LEDs of one name";
  blinking.deleteParam("labels");
  EXPECT_NO_THROW(read(blinking));
  blinking.setParam("mode", "instant");
  EXPECT_THROW(read(blinking), ParameterError) << "nothing is followed through darkness";

  ros::NodeHandle corners("~corners");
  corners.setParam("tracks/minimum_corner", std::vector<double>{0.0, 0.0, 0.0});
  corners.setParam("tracks/maximum_corner", std::vector<double>{2.0, 0.0, 2.0});
  EXPECT_THROW(read(corners), ParameterError) << "no LED would be in that box";

  ros::NodeHandle nh("~instant_prediction");
  nh.setParam("mode", "instant");
  nh.setParam("output/predict_to_now", true);
  EXPECT_THROW(read(nh), ParameterError);
}

}  // namespace
}  // namespace wiimote_tracker
