#include "requests.h"

#include <actionlib/client/simple_action_client.h>
#include <ros/node_handle.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>
#include <wiimote_tracker_msgs/CaptureCornerAction.h>
#include <wiimote_tracker_msgs/CheckConnection.h>
#include <wiimote_tracker_msgs/CheckPlace.h>
#include <wiimote_tracker_msgs/LearnMasks.h>
#include <wiimote_tracker_msgs/LoadRig.h>
#include <wiimote_tracker_msgs/MeasureLength.h>
#include <wiimote_tracker_msgs/SaveRig.h>
#include <wiimote_tracker_msgs/SolveCalibration.h>
#include <wiimote_tracker_msgs/StartCalibration.h>
#include <wiimote_tracker_msgs/StartWave.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <thread>

namespace wiimote_tracker::panel {
namespace {

using CaptureClient = actionlib::SimpleActionClient<wiimote_tracker_msgs::CaptureCornerAction>;

constexpr auto kLookPeriod = std::chrono::milliseconds(100);
constexpr int kLooksForServer = 50;  // for the action's server, at most
const std::string kNoAnswer =
    " does not answer: check that the calibration node runs, in the same version";

}  // namespace

Requests::~Requests() {
  const std::lock_guard<std::mutex> lock(mutex_);
  must_end_ = true;
  for (ros::ServiceClient& client : clients_)
    client.shutdown();
}

void Requests::send(const Request& request) {
  if (guide_->running() == "capture_corner" && request.service == "cancel") {
    is_called_off_ = true;
    return;
  }
  if (!guide_->running().empty() && request.service != "cancel")
    return;
  is_called_off_ = false;
  guide_->onRequest(request.service);
  sent_.push_front({request.service, std::async(std::launch::async, [this, request] {
                      try {
                        return perform(request);
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
    guide_->onAnswer(sent->service, sent->answer.get());
    sent = sent_.erase(sent);
  }
}

bool Requests::mustEnd() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return must_end_;
}

template <class Service>
std::string Requests::call(const std::string& name,
                           const std::function<void(typename Service::Request&)>& fill) {
  Service service;
  if (fill)
    fill(service.request);
  const std::string full_name = "calibration/" + name;
  // A persistent client, since only such a one can be interrupted.
  ros::ServiceClient client = ros::NodeHandle().serviceClient<Service>(full_name, true);
  std::list<ros::ServiceClient>::iterator place;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (must_end_)
      return "";
    place = clients_.insert(clients_.end(), client);
  }
  const bool is_answered = client.call(service);
  const std::lock_guard<std::mutex> lock(mutex_);
  clients_.erase(place);
  if (!is_answered)
    return full_name + kNoAnswer;
  return service.response.message;
}

std::string Requests::perform(const Request& request) {
  namespace msgs = wiimote_tracker_msgs;
  const std::string& service = request.service;
  const auto fillPath = [&](auto& file) { file.path = request.path; };
  if (service == "learn_masks")
    return call<msgs::LearnMasks>(service);
  if (service == "check_connection")
    return call<msgs::CheckConnection>(service);
  if (service == "start")
    return call<msgs::StartCalibration>(service, [&](auto& start) {
      start.side_x = request.side;
      start.without_square = static_cast<std::uint8_t>(request.without_square);
      start.wand_length = request.wand_length;
    });
  if (service == "capture_corner")
    return captureCorner(request);
  if (service == "hands_free")
    return call<std_srvs::SetBool>(service, [&](auto& hands_free) {
      hands_free.data = static_cast<std::uint8_t>(request.on);
    });
  if (service == "start_wave")
    return call<msgs::StartWave>(service,
                                 [&](auto& wave) { wave.wand_length = request.wand_length; });
  if (service == "solve")
    return call<msgs::SolveCalibration>(service);
  if (service == "measure_length")
    return call<msgs::MeasureLength>(service, [&](auto& taped) {
      taped.from_corner = static_cast<std::uint32_t>(request.ends[0]);
      taped.to_corner = static_cast<std::uint32_t>(request.ends[1]);
      taped.length = request.length;
    });
  if (service == "check" || service == "measure_place")
    return call<msgs::CheckPlace>(service, [&](auto& place) {
      place.known.x = request.known[0];
      place.known.y = request.known[1];
      place.known.z = request.known[2];
    });
  if (service == "save")
    return call<msgs::SaveRig>(service, fillPath);
  if (service == "load")
    return call<msgs::LoadRig>(service, fillPath);
  return call<std_srvs::Trigger>(service);  // undo, stop_wave, cancel, continuous/...
}

std::string Requests::captureCorner(const Request& request) {
  // The client's own waits follow ROS time, which may stand still.
  const std::string no_answer = "calibration/capture_corner" + kNoAnswer;
  CaptureClient client("calibration/capture_corner", true);
  for (int looks = 0; !client.isServerConnected(); ++looks) {
    if (looks == kLooksForServer || mustEnd())
      return no_answer;
    std::this_thread::sleep_for(kLookPeriod);
  }
  wiimote_tracker_msgs::CaptureCornerGoal goal;
  goal.retake = static_cast<std::uint8_t>(request.corner >= 0);
  goal.corner = static_cast<std::uint32_t>(std::max(request.corner, 0));
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
