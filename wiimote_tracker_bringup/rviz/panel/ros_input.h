#pragma once

#include "guide.h"
#include "health_view.h"
#include "tracker_view.h"
#include "tracks_view.h"

#include <ros/callback_queue.h>
#include <ros/message_event.h>
#include <ros/node_handle.h>
#include <ros/subscriber.h>

#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

namespace wiimote_tracker::panel {

/// What the pages show.
struct Views {
  TrackerView cameras;
  Guide guide;
  TracksView tracks;
  HealthView health;
};

/// Feeds views from ROS. A thread of its own asks the master for cameras and subscribes, since that
/// may wait. poll() hands the messages over, and never waits.
class RosInput {
 public:
  explicit RosInput(Views* views);
  ~RosInput();
  RosInput(const RosInput&) = delete;
  RosInput& operator=(const RosInput&) = delete;

  /// Hands over the newest messages. Called by the thread that owns the views.
  void poll();

  /// What is wrong with the ROS master, in words; empty: nothing.
  std::string masterProblem();

  /// The time that the views are told [s].
  static double now();

 private:
  void run();
  void subscribeTracker();
  void subscribeCamera(const std::string& name);
  std::optional<std::set<std::string>> findCameras() const;

  template <class Message>
  void subscribe(const std::string& topic,
                 std::uint32_t queue_size,
                 const std::function<void(const ros::MessageEvent<const Message>&)>& callback);

  Views* views_;
  ros::CallbackQueue queue_;
  ros::NodeHandle nh_;
  std::vector<ros::Subscriber> subscribers_;  // of the thread
  std::set<std::string> watched_;             // of the thread
  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<std::set<std::string>> cameras_;  // found, not handed over yet
  std::string master_problem_;
  bool must_end_ = false;
  std::thread thread_;
};

}  // namespace wiimote_tracker::panel
