#pragma once

#include <actionlib/server/action_server.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <wiimote_tracker_msgs/CaptureCornerAction.h>

#include <atomic>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace wiimote_tracker {

/// The action `calibration/capture_corner`: serves one goal after the other. Nothing that a client
/// sends ends the process: actionlib's own server throws, in a thread of its own, again and again
/// after it was sent a stamp of the year 2106. Goals are served in the order in which they come:
/// actionlib's simple server refuses those that are stamped before an earlier one, as after a step
/// of a clock, or from another computer.
class CaptureServer {
 public:
  using Goal = wiimote_tracker_msgs::CaptureCornerGoal;
  using Result = wiimote_tracker_msgs::CaptureCornerResult;
  using Feedback = wiimote_tracker_msgs::CaptureCornerFeedback;

  /// @param serve does what a goal asks for; called in a thread of the server
  CaptureServer(const ros::NodeHandle& nh, std::function<Result(const Goal&)> serve);
  ~CaptureServer();

  /// Why the goal that is served now should end: it was cancelled, another one came, or the server
  /// ends or starts anew; empty: it should not. For `serve`, as is publishFeedback().
  std::string whyCancelled() const;
  void publishFeedback(const Feedback& feedback) { current_.publishFeedback(feedback); }

 private:
  using Server = actionlib::ActionServer<wiimote_tracker_msgs::CaptureCornerAction>;
  using GoalHandle = Server::GoalHandle;

  void start();
  void checkStamp(const ros::Time& stamp);
  void takeGoal(const GoalHandle& goal);
  void cancelGoal(const GoalHandle& goal);
  bool acceptGoal();
  void serveGoal();

  ros::CallbackQueue queue_;
  ros::NodeHandle nh_;
  std::function<Result(const Goal&)> serve_;
  std::mutex serving_mutex_;  // held while a goal is served and while the server is exchanged
  std::condition_variable goal_came_;
  std::mutex goals_mutex_;  // guards the next five; locked after serving_mutex_
  GoalHandle current_;      // changes only with serving_mutex_ locked, too; invalid: none came yet
  std::atomic<bool> is_preempted_{false};
  std::atomic<bool> is_replaced_{false};  // by the next goal
  GoalHandle next_;                       // invalid: none waits
  bool is_next_cancelled_ = false;
  std::atomic<bool> is_restarting_{false};
  std::atomic<bool> is_ending_{false};
  std::vector<ros::Subscriber> stamp_checks_;
  // Of the server's topics: while these exist, what a server has sent arrives, also when it is
  // destroyed at once.
  std::vector<ros::Publisher> topics_;
  std::unique_ptr<Server> server_;
  // Handles all requests, and exchanges the server: so none reaches a server that is being
  // destroyed.
  std::thread requests_;
  std::thread goals_;
};

}  // namespace wiimote_tracker
