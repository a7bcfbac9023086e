// The shipped YAML and the defaults in the code say the same; what is wrong is refused by name.
#include "parameters.h"

#include <gtest/gtest.h>
#include <ros/ros.h>
#include <wiimote_tracker_msgs/parameter_reader.h>

#include <map>
#include <string>
#include <vector>

namespace wiimote_tracker {
namespace {

TrackingParameters read(const ros::NodeHandle& nh) {
  return TrackingParameters::read(ParameterReader(nh));
}

/// All that is a number, by its key.
std::map<std::string, double> numbersOf(const TrackingParameters& p) {
  const tracking::TrackerOptions& tracks = p.estimator.tracks;
  const motion::MotionOptions& motion = tracks.motion;
  const fusion::InstantFuserOptions& instant = p.estimator.instant;
  const auto number = [](std::size_t n) { return static_cast<double>(n); };
  return {
      {"pixel_stddev", tracks.pixel_stddev},
      {"tracks/stamp_stddev", tracks.stamp_stddev},
      {"tracks/detection_probability", tracks.detection_probability},
      {"tracks/ghost_rate", tracks.ghost_rate},
      {"tracks/merging_distance", tracks.merging_distance},
      {"tracks/maximum_range", tracks.maximum_range},
      {"tracks/gate", tracks.gate},
      {"tracks/birth_window", tracks.birth_window},
      {"tracks/birth_pixel_stddev", tracks.birth_pixel_stddev},
      {"tracks/minimum_angle", tracks.minimum_angle},
      {"tracks/confirmation_hits", number(tracks.confirmation_hits)},
      {"tracks/minimum_support", tracks.minimum_support},
      {"tracks/tracked_time", tracks.tracked_time},
      {"tracks/prediction_time", tracks.prediction_time},
      {"tracks/single_view_time", tracks.single_view_time},
      {"tracks/doubt_time", tracks.doubt_time},
      {"tracks/history", tracks.history},
      {"tracks/output_interval", tracks.output_interval},
      {"motion/fixed/drift", motion.fixed.drift},
      {"motion/fixed/start_rate", motion.fixed.start_rate},
      {"motion/swaying/drift", motion.swaying.drift},
      {"motion/swaying/start_rate", motion.swaying.start_rate},
      {"motion/smooth/stddev", motion.smooth.stddev},
      {"motion/smooth/time", motion.smooth.time},
      {"motion/gentle/stddev", motion.gentle.stddev},
      {"motion/gentle/time", motion.gentle.time},
      {"motion/brisk/stddev", motion.brisk.stddev},
      {"motion/brisk/time", motion.brisk.time},
      {"motion/sudden_random_walk", motion.sudden_random_walk},
      {"motion/stop_rate", motion.stop_rate},
      {"motion/rise_rate", motion.rise_rate},
      {"motion/settle_rate", motion.settle_rate},
      {"motion/initial_speed", motion.initial_speed},
      {"instant/minimum_angle", instant.triangulation.minimum_angle},
      {"instant/minimum_rays", number(instant.minimum_rays)},
      {"instant/maximum_reprojection_error", instant.maximum_reprojection_error},
      {"instant/camera_timeout", instant.camera_timeout},
      {"instant/maximum_gap", instant.maximum_gap},
      {"instant/maximum_spot_speed", instant.maximum_spot_speed},
      {"instant/maximum_range", instant.maximum_range},
      {"instant/maximum_leds", number(instant.maximum_leds)},
      {"instant/confirmations", number(instant.confirmations)},
      {"instant/maximum_speed", instant.maximum_speed},
      {"instant/maximum_absence", instant.maximum_absence},
      {"identity/exposure", p.identity.exposure},
      {"identity/decide_at", p.identity.identifier.decide_at},
      {"identity/steady", p.identity.identifier.steady},
      {"bodies/tracked_time", p.bodies.options.tracked_time},
      {"bodies/prediction_time", p.bodies.options.prediction_time},
      {"bodies/gate", p.bodies.options.gate},
      {"bodies/window", p.bodies.options.window},
      {"bodies/window_motion", p.bodies.options.window_motion},
      {"bodies/minimum_margin", p.bodies.options.minimum_margin},
      {"bodies/acceleration_density", p.bodies.options.motion.acceleration_density},
      {"bodies/angular_acceleration_density", p.bodies.options.motion.angular_acceleration_density},
      {"bodies/initial_speed", p.bodies.options.motion.initial_speed},
      {"bodies/initial_angular_speed", p.bodies.options.motion.initial_angular_speed},
      {"output/rate", p.output.rate},
      {"zones/hysteresis", p.zones.hysteresis},
      {"zones/timeout", p.zones.timeout},
      {"trigger/maximum_gap", p.trigger.maximum_gap},
      {"trigger/history", p.trigger.history},
      {"clock_tolerance", p.clock_tolerance},
      {"markers/rate", p.markers.rate},
      {"markers/image_plane_distance", p.markers.image_plane_distance},
      {"markers/trail_duration", p.markers.trail_duration},
  };
}

TEST(Parameters, ShippedFileHoldsTheDefaults) {
  const ros::NodeHandle nh("~shipped");
  const TrackingParameters defaults;
  const TrackingParameters shipped = read(nh);
  for (const char* key :
       {"labels", "mode", "instant/method", "tracks/minimum_corner", "tracks/maximum_corner",
        "identity/codes", "output/on_update", "output/predict_to_now", "output/publish_predicted"})
    EXPECT_TRUE(nh.hasParam(key)) << key;
  EXPECT_EQ(defaults.labels, shipped.labels);
  EXPECT_EQ(defaults.estimator.mode, shipped.estimator.mode);
  EXPECT_EQ(defaults.estimator.instant.triangulation.method,
            shipped.estimator.instant.triangulation.method);
  EXPECT_EQ(defaults.estimator.instant.triangulation.pixel_stddev,
            shipped.estimator.instant.triangulation.pixel_stddev);
  EXPECT_EQ(defaults.estimator.tracks.minimum_corner, shipped.estimator.tracks.minimum_corner);
  EXPECT_EQ(defaults.estimator.tracks.maximum_corner, shipped.estimator.tracks.maximum_corner);
  EXPECT_EQ(defaults.output.on_update, shipped.output.on_update);
  EXPECT_EQ(defaults.output.predict_to_now, shipped.output.predict_to_now);
  EXPECT_EQ(defaults.output.publish_predicted, shipped.output.publish_predicted);
  const auto expected = numbersOf(defaults);
  for (const auto& [key, value] : numbersOf(shipped)) {
    // How LEDs move stands in the code alone.
    EXPECT_EQ(key.find("motion/") != 0, nh.hasParam(key)) << key;
    EXPECT_EQ(expected.at(key), value) << key;
  }
}

TEST(Parameters, EveryNumberIsReadAndBounded) {
  for (const auto& [key, value] : numbersOf(TrackingParameters())) {
    ros::NodeHandle nh("~bounded");
    nh.setParam(key, -1e9);
    if (key == "tracks/confirmation_hits" || key == "instant/minimum_rays" ||
        key == "instant/maximum_leds" || key == "instant/confirmations")
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

TEST(Parameters, WhatIsSetIsTaken) {
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
  const TrackingParameters p = read(nh);
  EXPECT_EQ((std::vector<std::string>{"left", "right_hand"}), p.labels);
  EXPECT_EQ(tracking::Mode::kInstant, p.estimator.mode);
  EXPECT_EQ("mean_closest", methodWord(p.estimator));
  EXPECT_EQ(0.25, p.estimator.tracks.pixel_stddev);
  EXPECT_EQ(0.25, p.estimator.instant.triangulation.pixel_stddev);
  EXPECT_EQ(Eigen::Vector3d(-1.0, -2.0, 0.5), p.estimator.tracks.minimum_corner);
  EXPECT_EQ(3u, p.estimator.tracks.confirmation_hits);
  EXPECT_FALSE(p.output.on_update);
  EXPECT_EQ(30.0, p.output.rate);
  EXPECT_TRUE(p.output.publish_predicted);
}

TEST(Parameters, BlinkCodesSayWhatTheyAskOfTheTracker) {
  ros::NodeHandle nh("~blinking");
  nh.setParam("identity/codes", BLINK_CODES_CONFIG "/blink_codes_paper.yaml");
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

TEST(Parameters, EveryMethodHasItsWord) {
  using geometry::TriangulationMethod;
  tracking::EstimatorOptions options;
  EXPECT_EQ("track", methodWord(options));
  options.mode = tracking::Mode::kInstant;
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

TEST(Parameters, WhatIsWrongIsNamedInFull) {
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
  blinking.setParam("identity/codes", BLINK_CODES_CONFIG "/blink_codes.yaml");
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

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test_parameters");
  const ros::NodeHandle keep_alive;
  return RUN_ALL_TESTS();
}
