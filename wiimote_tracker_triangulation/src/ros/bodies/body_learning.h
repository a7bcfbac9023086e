#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_BODIES_BODY_LEARNING_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_BODIES_BODY_LEARNING_H

#include "wiimote_tracker_triangulation/body/constellation.h"
#include "wiimote_tracker_triangulation/body/learn_constellation.h"

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>
#include <wiimote_tracker_msgs/LearnBody.h>
#include <wiimote_tracker_msgs/TrackedPointArray.h>

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace wiimote_tracker {

/// The service learn_body. It is answered by a thread of its own, since that takes seconds in which
/// the tracker goes on; everything else is called by the tracker's thread.
class BodyLearning {
 public:
  /// @param file where bodies are kept; empty: none can be learned. @param bodies that are
  /// followed.
  /// @param names of other things.
  BodyLearning(const ros::NodeHandle& nh,
               const std::string& file,
               const std::vector<body::Constellation>& bodies,
               const std::vector<std::string>& names);
  ~BodyLearning();
  BodyLearning(const BodyLearning&) = delete;
  BodyLearning& operator=(const BodyLearning&) = delete;

  void addPoints(const wiimote_tracker_msgs::TrackedPointArray& points);

  /// Whether change() has something to tell. From any thread.
  bool hasChange() const { return has_change_; }

  /// The bodies to be followed from now on, when they are others than at the last call. While one
  /// is learned it is not followed, for its LEDs to be free.
  std::optional<std::vector<body::Constellation>> change();

 private:
  using LearnBody = wiimote_tracker_msgs::LearnBody;

  bool onRequest(LearnBody::Request& request, LearnBody::Response& response);
  std::string refusal(const LearnBody::Request& request) const;
  void collect(const LearnBody::Request& request);
  void learn(const LearnBody::Request& request, LearnBody::Response* response);
  void follow(const std::vector<body::Constellation>& bodies);

  std::string file_;
  std::vector<std::string> names_;
  std::vector<body::Constellation> bodies_;  // that are known; of the service's thread

  std::mutex mutex_;  // of all that follows
  std::condition_variable changed_;
  std::atomic<bool> is_collecting_{false};
  std::atomic<bool> has_change_{false};
  bool is_over_ = false;
  double duration_ = 0.0;                        // [s]
  std::set<std::string> labels_;                 // empty: all
  std::vector<body::LedsInstant> instants_;      // collected
  std::map<std::uint32_t, std::string> blinks_;  // by id: labels told by blinking
  std::vector<body::Constellation> followed_;

  ros::CallbackQueue queue_;
  ros::ServiceServer server_;
  ros::AsyncSpinner spinner_;
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_BODIES_BODY_LEARNING_H
