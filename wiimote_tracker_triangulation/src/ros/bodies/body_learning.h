#pragma once

#include "body/constellation.h"
#include "body/learn_constellation.h"
#include "geometry/file_guard.h"
#include "wiimote_tracker_triangulation/geometry/rig.h"

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>
#include <wiimote_tracker_msgs/LearnBody.h>
#include <wiimote_tracker_msgs/TrackedPointArray.h>

#include <condition_variable>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace wiimote_tracker {

/// The service learn_body. Its own thread answers, since that takes seconds. The tracker's thread
/// calls the public functions.
class BodyLearning {
 public:
  /// @param file for bodies; empty: the service refuses. @param bodies that are tracked.
  /// @param names that a body must not have. @param codes labels of LEDs that blink.
  BodyLearning(const ros::NodeHandle& nh,
               const std::string& file,
               const std::vector<body::Constellation>& bodies,
               const std::vector<std::string>& names,
               const std::vector<std::string>& codes);
  ~BodyLearning();
  BodyLearning(const BodyLearning&) = delete;
  BodyLearning& operator=(const BodyLearning&) = delete;

  /// A body must not have the name of a frame of the rig: TF would have it twice.
  void setRig(const geometry::Rig& rig);

  void addPoints(const wiimote_tracker_msgs::TrackedPointArray& points);

  /// The bodies to track from now on, when they changed since the last call. A body is not tracked
  /// while it is learned, so that its LEDs become tracks of their own.
  std::optional<std::vector<body::Constellation>> change();

 private:
  using LearnBody = wiimote_tracker_msgs::LearnBody;

  /// What was seen of the LEDs to learn from.
  struct Collected {
    std::vector<body::LedsInstant> instants;
    std::map<std::uint32_t, std::string> blinks;  // labels of LEDs that blink, by id
    std::set<std::string> seen_labels;            // of all tracked LEDs
    int jumps = 0;                                // how often time jumped back
  };

  bool onRequest(LearnBody::Request& request, LearnBody::Response& response);
  void check(const LearnBody::Request& request);
  Collected collect(const LearnBody::Request& request);
  std::string learn(const LearnBody::Request& request,
                    const Collected& collected,
                    LearnBody::Response* response);
  void track(const std::vector<body::Constellation>& bodies);

  std::string file_;
  std::vector<std::string> names_;
  std::set<std::string> codes_;
  // Only for the service's thread:
  std::vector<body::Constellation> bodies_;  // all known
  geometry::FileGuard guard_;                // of the file

  std::mutex mutex_;  // protects all below
  std::condition_variable changed_;
  bool is_collecting_ = false;
  bool is_over_ = false;
  std::vector<std::string> frames_;  // of the rig
  double duration_ = 0.0;            // [s]
  std::set<std::string> labels_;     // empty: all
  Collected collected_;
  std::optional<std::vector<body::Constellation>> change_;  // see change()

  ros::CallbackQueue queue_;
  ros::ServiceServer server_;
  ros::AsyncSpinner spinner_;
};

}  // namespace wiimote_tracker
