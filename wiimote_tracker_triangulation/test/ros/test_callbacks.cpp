// Image callbacks: in order and bounded; neither an exception in one nor the end of a tracker stops
// the process. Topics of LEDs end with these.
#include "geometry/random_rigs.h"
#include "ros/blob_image.h"
#include "ros/callbacks.h"
#include "ros/single_publishers.h"
#include "ros/triangulation.h"
#include "wiimote_tracker_triangulation/ros/conversions.h"

#include <diagnostic_msgs/DiagnosticArray.h>
#include <gtest/gtest.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <ros/spinner.h>
#include <std_msgs/Header.h>
#include <boost/algorithm/string/predicate.hpp>
#include <boost/make_shared.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <future>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace wiimote_tracker {
namespace {

using wiimote_tracker_msgs::IrBlobArray;

constexpr auto kDeadline = std::chrono::seconds(60);

/// A callback queue that the test calls.
class Callbacks : public ::testing::Test {
 protected:
  Callbacks() { nh_.setCallbackQueue(&queue_); }

  ros::Publisher advertise(const std::string& topic) {
    return nh_.advertise<std_msgs::Header>(topic, 100);
  }

  /// Within this process: the subscription has the message when this returns.
  static void publish(const ros::Publisher& publisher, std::uint32_t number) {
    const auto message = boost::make_shared<std_msgs::Header>();
    message->seq = number;
    publisher.publish(message);
  }

  ros::Subscriber subscribeTo(const std::string& topic, std::uint32_t queue_size) {
    return subscribe<std_msgs::Header>(nh_, topic, queue_size, [this](const auto& event) {
      handled_.push_back(event.getConstMessage()->seq);
    });
  }

  ros::CallbackQueue queue_;
  ros::NodeHandle nh_;
  std::vector<std::uint32_t> handled_;
};

TEST_F(Callbacks, HandleMessagesOfSeveralTopicsInTheOrderInWhichTheyCame) {
  const ros::Publisher first = advertise("first");
  const ros::Publisher second = advertise("second");
  const ros::Subscriber one = subscribeTo("first", 100);
  const ros::Subscriber other = subscribeTo("second", 100);
  std::vector<std::uint32_t> expected;
  for (std::uint32_t i = 0; i < 60; ++i) {
    publish(i % 3 == 0 ? second : first, i);
    expected.push_back(i);
  }
  EXPECT_TRUE(handled_.empty());
  queue_.callAvailable();
  EXPECT_EQ(expected, handled_);
}

TEST_F(Callbacks, DropTheOldestMessagesWhenTheQueueIsFull) {
  const ros::Publisher publisher = advertise("bounded");
  const ros::Subscriber subscriber = subscribeTo("bounded", 3);
  for (std::uint32_t i = 0; i < 5; ++i)
    publish(publisher, i);
  queue_.callAvailable();
  EXPECT_EQ((std::vector<std::uint32_t>{2, 3, 4}), handled_);
}

TEST_F(Callbacks, GoOnAfterAnException) {
  const ros::Publisher publisher = advertise("throwing");
  const ros::Subscriber subscriber =
      subscribe<std_msgs::Header>(nh_, "throwing", 10, [this](const auto& event) {
        if (event.getConstMessage()->seq == 1)
          throw std::runtime_error("one");
        handled_.push_back(event.getConstMessage()->seq);
      });
  for (std::uint32_t i = 0; i < 3; ++i)
    publish(publisher, i);
  EXPECT_NO_THROW(queue_.callAvailable());
  EXPECT_EQ((std::vector<std::uint32_t>{0, 2}), handled_);
}

bool isAdvertised(const std::string& topic) {
  ros::V_string topics;
  ros::this_node::getAdvertisedTopics(topics);
  return std::count(topics.begin(), topics.end(), ros::names::resolve(topic)) > 0;
}

TEST(LedTopics, EndWithAnLedThatIsSeenForAMomentOnly) {
  SinglePublishers publishers(ros::NodeHandle(), {}, OutputOptions());
  wiimote_tracker_msgs::TrackedPointArray points;
  points.points.resize(1);
  points.points[0].label = "led_7";
  points.points[0].state = wiimote_tracker_msgs::TrackedPoint::TRACKED;
  publishers.publish(points);
  const ros::WallTime deadline = ros::WallTime::now() + ros::WallDuration(20.0);
  while (!isAdvertised("led_7/point") && ros::WallTime::now() < deadline)
    ros::WallDuration(0.01).sleep();
  ASSERT_TRUE(isAdvertised("led_7/point"));
  points.points.clear();
  while (isAdvertised("led_7/point") && ros::WallTime::now() < deadline) {
    publishers.publish(points);
    ros::WallDuration(0.01).sleep();
  }
  EXPECT_FALSE(isAdvertised("led_7/point"));
}

TEST(ListedTopics, StayWhileNothingIsSeenUntilTheBodyIsRemoved) {
  SinglePublishers publishers(ros::NodeHandle(), {"hand"}, OutputOptions());
  body::Constellation wand;
  wand.name = "wand";
  publishers.setBodies({wand});
  publishers.publish(wiimote_tracker_msgs::TrackedPointArray());
  EXPECT_TRUE(isAdvertised("wand/pose"));
  publishers.setBodies({});
  publishers.publish(wiimote_tracker_msgs::TrackedPointArray());
  EXPECT_FALSE(isAdvertised("wand/pose"));
  EXPECT_TRUE(isAdvertised("hand/point"));
}

/// An image of LEDs that move, whose tracks come and go.
IrBlobArray image(const geometry::Camera& camera, std::uint64_t frame) {
  const double time = 1000.0 + 0.01 * static_cast<double>(frame);
  std::vector<Eigen::Vector3d> leds;
  if (frame % 400 <= 200) {
    for (const double height : {0.1, 0.5})
      leds.emplace_back(0.3 * std::cos(time), 0.3 * std::sin(time), height);
  }
  IrBlobArray image = blobImage(camera, time, leds);
  image.frame = frame;
  return image;
}

/// One camera's images wait 30 ms in the tracker's
/// queue, and those of the others do not.
TEST_F(Callbacks, ThatAreLateAreNotTakenForAWrongClock) {
  geometry::test::Random random(7);
  const geometry::Rig rig = geometry::test::randomRig(random, 3);
  const std::string late = rig.cameras[0].camera.name;
  ros::NodeHandle private_nh("~");
  private_nh.setCallbackQueue(&queue_);
  const ros::Publisher rigs =
      nh_.advertise<wiimote_tracker_msgs::RigCalibration>("calibration/rig", 1, true);
  rigs.publish(toMessage(rig));
  std::vector<ros::Publisher> publishers;
  for (const auto& camera : rig.cameras)
    publishers.push_back(nh_.advertise<IrBlobArray>(camera.camera.name + "/ir_blobs", 10));
  std::vector<std::string> said;
  const ros::Subscriber diagnostics =
      subscribe<diagnostic_msgs::DiagnosticArray>(nh_, "/diagnostics", 100, [&](const auto& event) {
        for (const auto& status : event.getConstMessage()->status) {
          if (boost::algorithm::ends_with(status.name, late))
            said.push_back(status.message);
        }
      });
  Triangulation tracker(nh_, private_nh);
  const ros::WallTime deadline = ros::WallTime::now() + ros::WallDuration(60.0);
  while (said.size() < 2 && ros::WallTime::now() < deadline) {
    for (std::size_t i = 0; i < publishers.size(); ++i) {
      IrBlobArray image = blobImage(rig.cameras[i].camera, ros::Time::now().toSec(), {});
      image.arrival = image.header.stamp;
      publishers[i].publish(boost::make_shared<IrBlobArray>(image));
      if (i == 0)
        ros::WallDuration(0.03).sleep();
    }
    queue_.callAvailable();
  }
  EXPECT_EQ((std::vector<std::string>{"Node starting up", "in use"}), said);
}

// Three threads publish images in this process, while trackers begin and end and the topics of LEDs
// without a label come and go.
TEST(Trackers, EndWhileImagesComeWithoutADeadlock) {
  constexpr int kTrackers = 10;
  geometry::test::Random random(7);
  const geometry::Rig rig = geometry::test::randomRig(random, 3);
  ros::NodeHandle nh;
  ros::NodeHandle private_nh("~");
  private_nh.setParam("labels", std::vector<std::string>());
  const ros::Publisher rigs =
      nh.advertise<wiimote_tracker_msgs::RigCalibration>("calibration/rig", 1, true);
  rigs.publish(toMessage(rig));
  ros::CallbackQueue listener_queue;
  ros::NodeHandle listener(nh);
  listener.setCallbackQueue(&listener_queue);
  std::atomic<std::uint64_t> outputs{0};
  const ros::Subscriber points = subscribe<wiimote_tracker_msgs::TrackedPointArray>(
      listener, "points", 100, [&](const auto&) { ++outputs; });
  ros::AsyncSpinner listening(1, &listener_queue);
  listening.start();

  auto all = std::async(std::launch::async, [&] {
    std::atomic<bool> is_over{false};
    std::vector<std::thread> drivers;
    std::array<std::atomic<std::uint64_t>, 3> frames{};  // they keep step, as clocks do
    for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
      drivers.emplace_back([&nh, &is_over, &frames, i, camera = rig.cameras[i].camera] {
        const ros::Publisher publisher =
            ros::NodeHandle(nh).advertise<IrBlobArray>(camera.name + "/ir_blobs", 100);
        for (std::uint64_t frame = 0; !is_over; ++frame) {
          frames[i] = frame;
          while (!is_over && *std::min_element(frames.begin(), frames.end()) < frame)
            ros::WallDuration(0.0001).sleep();
          publisher.publish(boost::make_shared<IrBlobArray>(image(camera, frame)));
          ros::WallDuration(0.0005).sleep();
        }
      });
    }
    for (int i = 0; i < kTrackers; ++i) {
      ros::CallbackQueue queue;
      ros::NodeHandle handle(nh);
      ros::NodeHandle private_handle(private_nh);
      handle.setCallbackQueue(&queue);
      private_handle.setCallbackQueue(&queue);
      Triangulation tracker(handle, private_handle);
      ros::AsyncSpinner thread(1, &queue);
      thread.start();
      const std::uint64_t before = outputs;
      while (outputs < before + 300 && ros::ok())
        ros::WallDuration(0.002).sleep();
    }
    is_over = true;
    for (std::thread& driver : drivers)
      driver.join();
  });
  if (all.wait_for(kDeadline) != std::future_status::ready) {
    std::fprintf(stderr, "The threads wait for one another.\n");
    std::abort();  // nothing can end them
  }
  all.get();
  EXPECT_GE(outputs, 300u * kTrackers);
}

}  // namespace
}  // namespace wiimote_tracker
