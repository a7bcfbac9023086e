#include "capture_server.h"

#include <wiimote_tracker_msgs/log_exceptions.h>

#include <chrono>
#include <cstdint>
#include <utility>

namespace wiimote_tracker {
namespace {

const char kCaptureAction[] = "calibration/capture_corner";
const char kReplaced[] = "another request to capture a corner came: wait until that is over";
constexpr double kLatestStamp = 3600.0;  // of a goal or cancellation, from now [s]
// Between two looks for goals and for the end of the node.
constexpr std::chrono::milliseconds kLookPeriod(100);

}  // namespace

CaptureServer::CaptureServer(const ros::NodeHandle& nh, std::function<Result(const Goal&)> serve)
    : nh_(nh), serve_(std::move(serve)) {
  nh_.setCallbackQueue(&queue_);
  const std::string name = kCaptureAction;
  using wiimote_tracker_msgs::CaptureCornerActionGoal;
  stamp_checks_ = {
      nh_.subscribe<CaptureCornerActionGoal>(
          name + "/goal", 50, [this](const auto& goal) { checkStamp(goal->goal_id.stamp); }),
      nh_.subscribe<actionlib_msgs::GoalID>(name + "/cancel", 50,
                                            [this](const auto& goal) { checkStamp(goal->stamp); })};
  constexpr std::uint32_t kQueue = 50;
  constexpr bool kLatched = true;  // as actionlib's
  topics_ = {
      nh_.advertise<wiimote_tracker_msgs::CaptureCornerActionResult>(name + "/result", kQueue),
      nh_.advertise<actionlib_msgs::GoalStatusArray>(name + "/status", kQueue, kLatched)};
  start();
  requests_ = std::thread([this] {
    while (!is_ending_)
      logExceptions(kCaptureAction, [this] {
        queue_.callOne(ros::WallDuration(std::chrono::duration<double>(kLookPeriod).count()));
      });
  });
  goals_ = std::thread([this] {
    while (!is_ending_)
      logExceptions(kCaptureAction, [this] { serveGoal(); });
  });
}

CaptureServer::~CaptureServer() {
  is_ending_ = true;
  requests_.join();
  goals_.join();
}

std::string CaptureServer::whyCancelled() const {
  if (is_ending_)
    return "the calibration node ends";
  if (is_restarting_)
    return "a request came from a computer whose clock is wrong: set that clock, then capture "
           "again";
  if (is_replaced_)
    return kReplaced;
  return is_preempted_ ? "the request was cancelled" : "";
}

void CaptureServer::start() {
  {
    const std::lock_guard<std::mutex> lock(goals_mutex_);
    current_ = next_ = GoalHandle();
  }
  server_.reset();
  server_ = std::make_unique<Server>(
      nh_, kCaptureAction, [this](const GoalHandle& goal) { takeGoal(goal); },
      [this](const GoalHandle& goal) { cancelGoal(goal); }, false);
  server_->start();
}

/// actionlib's server refuses all goals up to the stamp of a cancellation.
void CaptureServer::checkStamp(const ros::Time& stamp) {
  const double ahead = stamp.toSec() - ros::Time::now().toSec();
  if (ahead < kLatestStamp)
    return;
  ROS_WARN_THROTTLE(
      10.0,
      "a request to %s is stamped %.0f s in the future: its server starts anew; set the "
      "clock of whoever sent it",
      kCaptureAction, ahead);
  is_restarting_ = true;
  const std::lock_guard<std::mutex> after_the_goal(serving_mutex_);
  is_restarting_ = false;
  start();
}

/// A goal waits until the one that is served has ended, unless still another one comes.
void CaptureServer::takeGoal(const GoalHandle& goal) {
  const std::lock_guard<std::mutex> lock(goals_mutex_);
  if (next_.isValid()) {
    Result result;
    result.message = kReplaced;
    next_.setCanceled(result, result.message);
  }
  next_ = goal;
  is_next_cancelled_ = false;
  is_preempted_ = is_replaced_ = true;
  goal_came_.notify_one();
}

void CaptureServer::cancelGoal(const GoalHandle& goal) {
  const std::lock_guard<std::mutex> lock(goals_mutex_);
  if (goal == current_)
    is_preempted_ = true;
  else if (goal == next_)
    is_next_cancelled_ = true;
}

/// @returns whether a goal waited, which then is the current one.
bool CaptureServer::acceptGoal() {
  const std::lock_guard<std::mutex> lock(goals_mutex_);
  if (!next_.isValid())
    return false;
  current_ = std::exchange(next_, GoalHandle());
  is_preempted_ = std::exchange(is_next_cancelled_, false);
  is_replaced_ = false;
  current_.setAccepted();
  return true;
}

void CaptureServer::serveGoal() {
  std::unique_lock<std::mutex> lock(serving_mutex_);
  if (!goal_came_.wait_for(lock, kLookPeriod, [this] { return acceptGoal(); }))
    return;
  const Result result = serve_(*current_.getGoal());
  if (result.success)
    current_.setSucceeded(result, result.message);
  else if (is_preempted_)
    current_.setCanceled(result, result.message);
  else
    current_.setAborted(result, result.message);
}

}  // namespace wiimote_tracker
