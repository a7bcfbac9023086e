#include "requests.h"

#include <actionlib/client/simple_action_client.h>
#include <wiimote_tracker_msgs/CaptureCornerAction.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <thread>

namespace wiimote_tracker::panel {
namespace {

using CaptureClient = actionlib::SimpleActionClient<wiimote_tracker_msgs::CaptureCornerAction>;

constexpr auto kLookPeriod = std::chrono::milliseconds(100);
constexpr int kLooksForServer = 50;  // for the action's server, at most

}  // namespace

Requests::~Requests() {
  const std::lock_guard<std::mutex> lock(mutex_);
  must_end_ = true;
  for (ros::ServiceClient& client : clients_)
    client.shutdown();
}

void Requests::send(const Request& request) {
  if (guide_->running() == "capture_corner" && request.name == "cancel") {
    is_called_off_ = true;
    return;
  }
  if (!guide_->running().empty() && request.name != "cancel")
    return;
  is_called_off_ = false;
  guide_->onRequest(request.name);
  sent_.push_front({request.name, std::async(std::launch::async, [this, request] {
                      try {
                        return request.call(this);
                      } catch (const std::exception& error) {
                        return std::string(error.what());
                      }
                    })});
}

void Requests::poll() {
  std::optional<Progress> progress;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    progress.swap(progress_);
  }
  if (progress)
    guide_->onProgress(progress->text, progress->share);
  // What was cancelled has the last word.
  for (auto sent = sent_.begin(); sent != sent_.end();) {
    if (sent->answer.wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
      ++sent;
      continue;
    }
    guide_->onAnswer(sent->name, sent->answer.get());
    sent = sent_.erase(sent);
  }
}

bool Requests::mustEnd() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return must_end_;
}

std::string Requests::captureCorner(int corner) {
  // The client's own waits follow ROS time, which may stand still.
  const std::string no_answer = std::string("calibration/capture_corner") + kNoAnswer;
  CaptureClient client("calibration/capture_corner", true);
  for (int looks = 0; !is_called_off_ && !client.isServerConnected(); ++looks) {
    if (looks == kLooksForServer || mustEnd())
      return no_answer;
    std::this_thread::sleep_for(kLookPeriod);
  }
  if (is_called_off_)
    return "the request was cancelled";
  wiimote_tracker_msgs::CaptureCornerGoal goal;
  goal.retake = static_cast<std::uint8_t>(corner >= 0);
  goal.corner = static_cast<std::uint32_t>(std::max(corner, 0));
  client.sendGoal(goal, {}, {}, [this](const auto& feedback) {
    const std::lock_guard<std::mutex> lock(mutex_);
    progress_ = Progress{feedback->message, feedback->progress};
  });
  while (!client.getState().isDone()) {
    std::this_thread::sleep_for(kLookPeriod);
    const bool must_end = mustEnd();
    // Without our lock: the client's own is held while it reports progress, above.
    if (is_called_off_ || must_end)
      client.cancelGoal();
    if (must_end || !client.isServerConnected())
      return no_answer;
  }
  if (client.getState() == actionlib::SimpleClientGoalState::LOST)  // its server does not know it
    return "The calibration node was started again: capture again";
  return client.getResult()->message;
}

}  // namespace wiimote_tracker::panel
