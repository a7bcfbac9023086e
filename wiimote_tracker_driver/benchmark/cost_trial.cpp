#include "trials.h"

#include "own_master.h"
#include "process.h"
#include "temporary_folder.h"
#include "virtual_remotes.h"

#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <wiimote_tracker_msgs/IrBlobArray.h>

#include <sched.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>

namespace wiimote_tracker {
namespace {

using wiimote_tracker_msgs::IrBlobArray;

constexpr int kTurns = 4;             // without and with a subscriber
constexpr double kSettling = 2.0;     // [s] After the subscription has changed.
constexpr double kLearning = 30.0;    // [s] Until the exposure clock has learned.
constexpr double kStartsWithin = 60;  // [s]

/// Keeps this process and its children on one processor. The driver takes half as long again for a
/// report that comes from another one, and the kernel alone decides which it comes from.
void stayOnOneProcessor() {
  cpu_set_t one;
  CPU_ZERO(&one);
  CPU_SET(::sched_getcpu(), &one);
  if (::sched_setaffinity(0, sizeof(one), &one) != 0)
    throw std::runtime_error("this process cannot be kept on one processor");
}

/// As in the tutorials of ROS.
void publishOnly() {
  ros::init(ros::M_string(), "publisher_only");
  ros::NodeHandle nh;
  const ros::Publisher publisher = nh.advertise<IrBlobArray>("publisher_only/ir_blobs", 20);
  ros::WallRate rate(1.0 / VirtualRemotes::kPeriod);
  for (std::uint64_t frame = 0; ros::ok(); ++frame) {
    const auto message = boost::make_shared<IrBlobArray>();
    message->header.stamp = message->arrival = ros::Time::now();
    message->header.frame_id = "wiimote_1_optical_frame";
    message->camera = "wiimote_1";
    message->identity = "00:1f:32:00:00:00";
    message->frame = frame;
    message->blobs.resize(1);
    publisher.publish(message);
    ros::spinOnce();
    rate.sleep();
  }
}

void runDriver(const std::string& socket) {
  const auto self = std::filesystem::read_symlink("/proc/self/exe");
  const std::string program = self.parent_path() / "driver_node";
  ::execl(program.c_str(), program.c_str(), "__ns:=/wiimote_1",
          ("_device:=virtual:" + socket).c_str(), nullptr);
}

constexpr std::array<const char*, 2> kTopics{"/wiimote_1/ir_blobs", "/publisher_only/ir_blobs"};

/// Counts what both nodes publish while it subscribes.
class Listener {
 public:
  void subscribe() {
    for (std::size_t i = 0; i < kTopics.size(); ++i)
      subscribers_[i] = nh_.subscribe<IrBlobArray>(
          kTopics[i], 100, [this, i](const IrBlobArray::ConstPtr&) { ++received_[i]; });
  }
  void unsubscribe() { subscribers_ = {}; }
  /// Spins for so long [s]. @returns what came of each.
  std::array<int, 2> spin(double duration) {
    received_ = {};
    for (const double end = steadyNow() + duration; steadyNow() < end;)
      ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.1));
    return received_;
  }

 private:
  ros::NodeHandle nh_;
  std::array<ros::Subscriber, 2> subscribers_;
  std::array<int, 2> received_{};
};

}  // namespace

Results runCost(double duration) {
  stayOnOneProcessor();
  const TemporaryFolder folder;
  const VirtualRemotes remotes(1, folder.path());
  OwnMaster master;
  const Process publisher(publishOnly);
  master.connect();
  const Process driver([&] { runDriver(remotes.socket(0)); });

  Listener listener;
  listener.subscribe();
  for (double waited = 0.0; listener.spin(1.0)[0] < 50; waited += 1.0)
    if (waited > kStartsWithin)
      throw std::runtime_error("no image came: stop what keeps this computer busy");
  listener.spin(kLearning);

  std::array<double, 2> with{}, without{};
  for (int turn = 0; turn < 2 * kTurns; ++turn) {
    const bool subscribed = turn % 2 == 1;
    if (subscribed)
      listener.subscribe();
    else
      listener.unsubscribe();
    listener.spin(kSettling);
    const double begin = steadyNow();
    const std::array<double, 2> before{driver.processorTime(), publisher.processorTime()};
    listener.spin(duration / kTurns);
    const std::array<double, 2> after{driver.processorTime(), publisher.processorTime()};
    for (std::size_t i = 0; i < 2; ++i)
      (subscribed ? with : without)[i] +=
          100.0 / kTurns * (after[i] - before[i]) / (steadyNow() - begin);
  }
  ros::shutdown();
  const char* percent = "% of a core";
  return {{"driver", without[0], percent},
          {"publisher", without[1], percent},
          {"ratio", without[0] / without[1], "1"},
          {"driver_with_subscriber", with[0], percent},
          {"publisher_with_subscriber", with[1], percent},
          {"ratio_with_subscriber", with[0] / with[1], "1"}};
}

}  // namespace wiimote_tracker
