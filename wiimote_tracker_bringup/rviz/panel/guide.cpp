#include "guide.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>

namespace wiimote_tracker::panel {
namespace {

// What the node may ask for next, CalibrationStatus.next_request; another value is of a newer node.
// Other buttons do not belong here.
const std::set<std::string> kNextRequests = {
    "learn_masks",     "check_connection", "start", "capture_corner",
    "start_wave",      "stop_wave",        "solve", "save",
    "continuous/apply"};
constexpr const char* kLost =
    "The calibration node was started again: what was captured, or solved and not saved, is lost. "
    "Start again.";

}  // namespace

// --- What comes in

void Guide::onStatus(const Status& status, double now) {
  if (status_ && status.message != status_->message)
    answer_.clear();  // the node's message is newer
  if (status_ && status.header.seq < status_->header.seq && status_->step >= Status::READY &&
      status_->step <= Status::SOLVED)
    is_lost_ = true;  // Another publisher counts anew.
  status_ = status;
  status_at_ = now;
  is_effect_known_ = true;
}

void Guide::onRequest(const std::string& service) {
  if (service != "cancel")  // What is cancelled still runs.
    running_ = service;
  is_lost_ = false;
  answer_.clear();
  progress_text_.clear();
  progress_ = 0.0;
}

void Guide::onProgress(const std::string& text, double share) {
  progress_text_ = text;
  progress_ = share;
}

void Guide::onAnswer(const std::string& service, const std::string& text) {
  if (service != "cancel")
    running_.clear();
  is_effect_known_ = false;
  answer_ = text;
}

// --- What it means

std::string Guide::answer() const {
  if (!running_.empty())
    return progress_text_;
  if (answer_.empty() && is_lost_)
    return kLost;
  return answer_.empty() && status_ ? status_->message : answer_;
}

double Guide::progress() const {
  const double share = running_ == "capture_corner" ? progress_ : status_ ? status_->progress : 0.0;
  return std::isfinite(share) ? std::clamp(share, 0.0, 1.0) : 0.0;
}

std::vector<std::string> Guide::remarks() const {
  if (!status_)
    return {};
  std::vector<std::string> result;
  if (!status_->walk.empty())
    result.push_back(status_->walk);
  result.insert(result.end(), status_->missing.begin(), status_->missing.end());
  // Once there is a rig, a camera may see several LEDs, or none.
  const bool is_calibrated =
      status_->step == Status::SAVED || (status_->step == Status::IDLE && !status_->rig_id.empty());
  for (const auto& camera : status_->cameras) {
    for (const std::string& text : {is_calibrated ? "" : camera.problem, camera.health}) {
      if (!text.empty())
        result.push_back(camera.name + ": " + text);
    }
  }
  return result;
}

bool Guide::isBusy() const {
  return status_ && (status_->step == Status::CAPTURING || status_->step == Status::WAVING ||
                     status_->step == Status::SOLVING || status_->step == Status::MASKING ||
                     status_->step == Status::MEASURING);
}

const wiimote_tracker_msgs::CalibrationVerdict* Guide::verdict() const {
  if (!verdict_ || !status_ || verdict_->rig_id != status_->rig_id)
    return nullptr;
  const std::uint8_t step = status_->step;
  // Meanwhile a new rig is being calibrated.
  const bool is_old = step == Status::READY || step == Status::CAPTURING ||
                      step == Status::WAVING || step == Status::COMPLETE || step == Status::SOLVING;
  return is_old ? nullptr : &*verdict_;
}

Advice Guide::advice(double now) const {
  if (isSilent(now))
    return {"No node",
            "No calibration node answers: start it with  roslaunch wiimote_tracker_bringup "
            "tracker.launch cameras:=FILE, or start rviz with its ROS_NAMESPACE",
            "", ""};
  Advice advice = {status_->next_title, status_->next_sentence, "", ""};
  if (kNextRequests.count(status_->next_request) == 0 || status_->next_label.empty())
    return advice;
  advice.button = status_->next_label;
  advice.button[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(advice.button[0])));
  advice.request = status_->next_request;
  advice.corner = status_->next_corner;
  return advice;
}

}  // namespace wiimote_tracker::panel
