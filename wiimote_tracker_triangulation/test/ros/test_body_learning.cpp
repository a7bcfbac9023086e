// What learn_body answers where a bag is played in a loop, labels are wrong, or its file changed.
#include "ros/bodies/body_learning.h"

#include <gtest/gtest.h>
#include <ros/ros.h>
#include <unistd.h>
#include <Eigen/Core>

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <future>
#include <string>
#include <vector>

namespace wiimote_tracker {
namespace {

using wiimote_tracker_msgs::LearnBody;
using wiimote_tracker_msgs::TrackedPoint;
using wiimote_tracker_msgs::TrackedPointArray;

constexpr double kPeriod = 0.01;  // of images [s]

/// Three LEDs at rest.
TrackedPointArray pointsAt(double time) {
  TrackedPointArray points;
  points.header.stamp = ros::Time(time);
  const std::vector<Eigen::Vector3d> leds = {{0.0, 0.0, 0.0}, {0.1, 0.0, 0.0}, {0.0, 0.2, 0.0}};
  for (std::size_t i = 0; i < leds.size(); ++i) {
    TrackedPoint point;
    point.id = static_cast<std::uint32_t>(i);
    point.label = "led_" + std::to_string(i);
    point.state = TrackedPoint::TRACKED;
    point.position.x = leds[i].x();
    point.position.y = leds[i].y();
    point.position_covariance[0] = point.position_covariance[4] = point.position_covariance[8] =
        1e-6;
    points.points.push_back(point);
  }
  return points;
}

std::string learnedFile() {
  return testing::TempDir() + "learned_" + std::to_string(::getpid()) + ".yaml";
}

/// Learns 0.5 s of a bag that starts over after so many images.
LearnBody::Response learnInLoopsOf(int images, const std::vector<std::string>& labels = {}) {
  const std::string file = learnedFile();
  BodyLearning learning(ros::NodeHandle(), file, {}, {}, {});
  auto answer = std::async(std::launch::async, [&labels] {
    LearnBody call;
    call.request.name = "wand";
    call.request.duration = 0.5;
    call.request.labels = labels;
    EXPECT_TRUE(ros::service::call("learn_body", call));
    return call.response;
  });
  // Without end the service would give up, since no more points come.
  for (int i = 0;
       i < 20000 && answer.wait_for(std::chrono::milliseconds(1)) != std::future_status::ready; ++i)
    learning.addPoints(pointsAt(1000.0 + kPeriod * (i % images)));
  const LearnBody::Response response = answer.get();
  std::remove(file.c_str());
  return response;
}

TEST(BodyLearning, EndsWhereTheLoopOfABagIsTooShort) {
  const LearnBody::Response response = learnInLoopsOf(30);
  EXPECT_FALSE(response.success);
  EXPECT_NE(std::string::npos, response.message.find("play a longer bag")) << response.message;
}

TEST(BodyLearning, GoesOnAfterABagHasStartedOver) {
  const LearnBody::Response response = learnInLoopsOf(80);
  EXPECT_TRUE(response.success) << response.message;
  EXPECT_EQ(3u, response.leds.size());
}

TEST(BodyLearning, NamesLabelsThatNoLedHas) {
  const std::string none = learnInLoopsOf(80, {"x", "y", "z"}).message;
  EXPECT_EQ(0u, none.find("no LED with the label x, y, z was seen, but led_0, led_1, led_2: "))
      << none;
  const std::string two = learnInLoopsOf(80, {"led_0", "x", "led_2"}).message;
  EXPECT_NE(std::string::npos, two.find("saw 2 LEDs at once")) << two;
  EXPECT_NE(std::string::npos, two.find("no LED with the label x was seen")) << two;
  const LearnBody::Response one_too_many = learnInLoopsOf(80, {"led_0", "led_1", "led_2", "x"});
  EXPECT_TRUE(one_too_many.success) << one_too_many.message;
  EXPECT_NE(std::string::npos, one_too_many.message.find("but no LED with the label x was seen"))
      << one_too_many.message;
}

TEST(BodyLearning, RefusesALabelGivenTwice) {
  const LearnBody::Response response = learnInLoopsOf(80, {"led_0", "led_1", "led_0"});
  EXPECT_FALSE(response.success);
  EXPECT_NE(std::string::npos, response.message.find("labels has 'led_0' twice"))
      << response.message;
}

TEST(BodyLearning, KeepsWhatWasWrittenIntoTheFileMeanwhile) {
  const std::string file = learnedFile();
  std::ofstream(file) << "as it was read";
  BodyLearning learning(ros::NodeHandle(), file, {}, {}, {});
  std::ofstream(file) << "with a body that a person measured";
  LearnBody call;
  call.request.name = "wand";
  EXPECT_TRUE(ros::service::call("learn_body", call));
  EXPECT_FALSE(call.response.success);
  EXPECT_NE(std::string::npos, call.response.message.find("was changed after it was read"))
      << call.response.message;
  std::remove(file.c_str());
}

}  // namespace
}  // namespace wiimote_tracker
