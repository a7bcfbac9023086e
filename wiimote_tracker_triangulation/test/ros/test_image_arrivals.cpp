#include "image_arrivals.h"

#include <gtest/gtest.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <std_msgs/Header.h>
#include <boost/make_shared.hpp>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <future>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace wiimote_tracker {
namespace {

using wiimote_tracker_msgs::IrBlobArray;

constexpr double kDeadline = 60.0;  // [s]

/// Waits until it is so; false when it never is.
template <typename Condition>
bool wait(Condition condition) {
  const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(kDeadline);
  while (!condition() && ros::WallTime::now() < end)
    ros::WallDuration(0.002).sleep();
  return condition();
}

void ignore(const wiimote_tracker_msgs::IrBlobArrayConstPtr&) {}

/// The owner's thread and what was handled.
class ImageArrivalsTest : public ::testing::Test {
 protected:
  ImageArrivalsTest() {
    nh_.setCallbackQueue(&queue_);
    owner_ = std::thread([this] {
      while (!is_over_)
        queue_.callAvailable(ros::WallDuration(0.01));
    });
  }

  ~ImageArrivalsTest() override { endOwner(); }

  /// Before what its tasks use ends.
  void endOwner() {
    is_over_ = true;
    if (owner_.joinable())
      owner_.join();
  }

  void note(const ArrivedImage& image) {
    const std::lock_guard<std::mutex> lock(mutex_);
    threads_[image.camera] = std::this_thread::get_id();
    is_in_order_ = is_in_order_ && image.message->frame >= frames_[image.camera];
    frames_[image.camera] = image.message->frame;
  }

  bool isHandled(const std::string& camera, std::uint64_t frame) {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto found = frames_.find(camera);
    return found != frames_.end() && found->second == frame;
  }

  std::thread::id threadOf(const std::string& camera) {
    const std::lock_guard<std::mutex> lock(mutex_);
    return threads_[camera];
  }

  void publish(const ros::Publisher& publisher, std::uint64_t frame) {
    const auto image = boost::make_shared<IrBlobArray>();
    image->frame = frame;
    publisher.publish(image);
  }

  ros::CallbackQueue queue_;
  ros::NodeHandle nh_;
  std::atomic<bool> is_over_{false};
  std::thread owner_;
  std::mutex mutex_;
  std::map<std::string, std::thread::id> threads_;  // by camera: of its last image
  std::map<std::string, std::uint64_t> frames_;
  bool is_in_order_ = true;
};

TEST_F(ImageArrivalsTest, WhatIsPublishedInTheProcessIsHandledBeforePublishReturns) {
  ImageArrivals images(
      nh_, [this](const ArrivedImage& image) { note(image); }, [] {});
  images.subscribe({"near"});
  const ros::Publisher near = nh_.advertise<IrBlobArray>("near/ir_blobs", 10);
  publish(near, 7);
  EXPECT_TRUE(isHandled("near", 7));
  EXPECT_EQ(std::this_thread::get_id(), threadOf("near"));
}

TEST_F(ImageArrivalsTest, WhatComesOverTheNetworkIsHandledByTheOwner) {
  ImageArrivals images(
      nh_, [this](const ArrivedImage& image) { note(image); }, [] {});
  images.subscribe({"far"});
  ASSERT_TRUE(wait([&] { return isHandled("far", 0); }));
  EXPECT_EQ(owner_.get_id(), threadOf("far"));
  endOwner();
}

TEST_F(ImageArrivalsTest, WhatIsLatchedIsHandledByTheOwner) {
  const ros::Publisher latched = nh_.advertise<IrBlobArray>("latched/ir_blobs", 10, true);
  ImageArrivals images(
      nh_, [this](const ArrivedImage& image) { note(image); }, [] {});
  publish(latched, 3);
  images.subscribe({"latched"});
  ASSERT_TRUE(wait([&] { return isHandled("latched", 3); }));
  EXPECT_EQ(owner_.get_id(), threadOf("latched"));
  publish(latched, 4);
  ASSERT_TRUE(wait([&] { return isHandled("latched", 4); }));
  EXPECT_EQ(owner_.get_id(), threadOf("latched"));
  endOwner();
}

TEST_F(ImageArrivalsTest, TheOwnerDoesItsTaskWhenAskedAlone) {
  std::promise<std::thread::id> by;
  ImageArrivals images(
      nh_, [this](const ArrivedImage& image) { note(image); },
      [&] { by.set_value(std::this_thread::get_id()); });
  images.askForTask();
  std::future<std::thread::id> thread = by.get_future();
  ASSERT_EQ(std::future_status::ready,
            thread.wait_for(std::chrono::seconds(static_cast<int>(kDeadline))));
  EXPECT_EQ(owner_.get_id(), thread.get());
  endOwner();
}

// Three threads publish images, each of which is handled by publishing.
// Meanwhile the owner makes and ends topics and subscriptions, and so does another thread.
TEST_F(ImageArrivalsTest, NothingLocksUp) {
  constexpr int kChanges = 20;
  const ros::Publisher out = nh_.advertise<std_msgs::Header>("out", 10);
  std::atomic<int> heard{0};
  const ros::Subscriber listener =
      nh_.subscribe<std_msgs::Header>("out", 10, [&](const std_msgs::HeaderConstPtr&) { ++heard; });
  std::vector<ros::Publisher> publishers;
  for (const std::string camera : {"first", "second", "third"})
    publishers.push_back(nh_.advertise<IrBlobArray>(camera + "/ir_blobs", 10));
  std::mutex topics;  // roscpp lets only one thread end topics while others are made
  std::atomic<int> owners_changes{0}, others_changes{0};
  ImageArrivals* self = nullptr;
  ImageArrivals images(
      nh_,
      [&](const ArrivedImage& image) {
        note(image);
        out.publish(boost::make_shared<std_msgs::Header>());
        if (image.message->frame % 16 == 0)
          self->askForTask();
      },
      [&] {
        const std::lock_guard<std::mutex> lock(topics);
        ros::Publisher changing = nh_.advertise<std_msgs::Header>("owners", 10);
        changing.publish(boost::make_shared<std_msgs::Header>());
        const bool has_third = owners_changes % 2 == 0;
        self->subscribe(has_third ? std::vector<std::string>{"first", "second", "third"}
                                  : std::vector<std::string>{"first", "second"});
        ++owners_changes;
      });
  self = &images;
  images.subscribe({"first", "second", "third"});

  auto all = std::async(std::launch::async, [&] {
    const auto go_on = [&] { return owners_changes < kChanges || others_changes < kChanges; };
    std::vector<std::thread> threads;
    for (const ros::Publisher& publisher : publishers) {
      threads.emplace_back([&] {
        std::uint64_t frame = 1;
        while (go_on()) {
          publish(publisher, frame++);
          ros::WallDuration(0.0005).sleep();  // locks of roscpp are not fair
        }
        publish(publisher, 1000000000);
      });
    }
    while (go_on()) {
      const std::lock_guard<std::mutex> lock(topics);
      ros::NodeHandle nh;
      ros::Publisher changing = nh.advertise<std_msgs::Header>("others", 10);
      ros::Subscriber subscriber = nh.subscribe<IrBlobArray>("first/ir_blobs", 10, &ignore);
      subscriber.getNumPublishers();
      ++others_changes;
    }
    for (std::thread& thread : threads)
      thread.join();
  });
  if (all.wait_for(std::chrono::seconds(static_cast<int>(kDeadline))) !=
      std::future_status::ready) {
    std::fprintf(stderr, "The threads wait for one another.\n");
    std::abort();  // nothing can end them
  }
  EXPECT_TRUE(
      wait([&] { return isHandled("first", 1000000000) && isHandled("second", 1000000000); }));
  EXPECT_TRUE(is_in_order_);
  EXPECT_TRUE(wait([&] { return heard > 0; }));
  endOwner();
}

}  // namespace
}  // namespace wiimote_tracker

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test_image_arrivals");
  const ros::NodeHandle nh;
  return RUN_ALL_TESTS();
}
