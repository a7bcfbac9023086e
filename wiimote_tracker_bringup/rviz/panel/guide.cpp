#include "guide.h"

#include <algorithm>
#include <cmath>

namespace wiimote_tracker::panel {
namespace {

const std::array<const char*, 4> kCornerHints = {"the origin of the world", "along x",
                                                 "counter-clockwise seen from above puts z up",
                                                 "the last one"};

Request requestOf(Command command) {
  Request request;
  request.command = command;
  return request;
}

}  // namespace

// --- What comes in

void Guide::onStatus(const Status& status, double now) {
  if (status_ && status.message != status_->message)
    answer_.clear();  // the node's message is newer
  status_ = status;
  status_at_ = now;
  is_known_ = true;
  Places places;
  for (const auto& camera : status.cameras) {
    if (camera.sees_led)
      places[camera.name] = {camera.x, camera.y};
  }
  if (corners_.size() + 1 == status.corners_captured)
    corners_.push_back(places);
  else
    corners_.resize(status.corners_captured);
}

void Guide::onRequest(Command command) {
  if (command != Command::kCancel)  // What is cancelled still runs.
    running_ = command;
  answer_.clear();
  progress_text_.clear();
  progress_ = 0.0;
}

void Guide::onProgress(const std::string& text, double share) {
  progress_text_ = text;
  progress_ = share;
}

void Guide::onAnswer(Command command, bool good, const std::string& text) {
  if (command != Command::kCancel)
    running_ = Command::kNone;
  is_known_ = false;
  answer_ = text;
  if (command == Command::kStart && good) {
    tried_.erase({Command::kStartWave, false});
    corners_.clear();
  }
  tried_.insert({command, good});
}

// --- What it means

std::string Guide::answer() const {
  if (running_ != Command::kNone)
    return progress_text_;
  return answer_.empty() && status_ ? status_->message : answer_;
}

double Guide::progress() const {
  const double share = running_ == Command::kCapture ? progress_
                       : status_                     ? status_->progress
                                                     : 0.0;
  return std::isfinite(share) ? std::clamp(share, 0.0, 1.0) : 0.0;
}

std::vector<std::string> Guide::remarks() const {
  if (!status_)
    return {};
  std::vector<std::string> result = status_->missing;
  for (const auto& camera : status_->cameras) {
    for (const std::string& text : {camera.problem, camera.health}) {
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
  return verdict_ && status_ && verdict_->rig_id == status_->rig_id ? &*verdict_ : nullptr;
}

Advice Guide::advice(double now) const {
  if (isSilent(now))
    return {"No node",
            "No calibration node answers: start it with  roslaunch wiimote_tracker_bringup "
            "calibrate.launch  or tracker.launch.",
            "",
            {}};
  switch (status_->step) {
    case Status::IDLE:
      return beforeStart();
    case Status::READY:
      return nextCorner();
    case Status::WAVING:
      return waving();
    case Status::COMPLETE:
      return complete();
    case Status::SOLVED:
      return solved();
    case Status::SAVED:
      return {"Ready",
              "The rig is calibrated. To check it, put the LED on a place that you know.",
              "",
              {}};
    case Status::SOLVING:
      return {"Solving", "The cameras are solved.", "", {}};
    case Status::MASKING:
      return {"LED off", "Leave the LED off.", "", {}};
    default:
      return {"Hold still", "Keep the LED still.", "", {}};
  }
}

// --- Steps

Advice Guide::beforeStart() const {
  if (!tried(Command::kMasks, true))
    return {"LED off",
            "Switch the LED off or take it away. The lights of the room are learned then, to "
            "ignore them.",
            "Learn the lights", requestOf(Command::kMasks)};
  if (!tried(Command::kConnection, true))
    return {"LED on", "Switch the LED on and hold it up where all cameras see it.",
            "Check that they see it", requestOf(Command::kConnection)};
  return {"Square", "Measure the side of the square on the floor.", "Start",
          requestOf(Command::kStart)};
}

Advice Guide::nextCorner() const {
  if (status_->corners_needed == 0)
    return {"Wand", "Take the wand and say how long it is.", "Begin the wave",
            requestOf(Command::kStartWave)};
  const std::size_t corner = status_->corners_captured;
  const std::string name = "corner " + std::to_string(corner + 1);
  const std::string hint = corner < kCornerHints.size() ? kCornerHints[corner] : "";
  const std::string title = "Corner " + std::to_string(corner + 1);
  if (status_->hands_free)
    return {
        title, "Hold the LED still on " + name + " (" + hint + ") until it is captured.", "", {}};
  return {title, "Put the LED on " + name + " (" + hint + ").", "Capture " + name,
          requestOf(Command::kCapture)};
}

Advice Guide::waving() const {
  if (!status_->missing.empty())
    return {"Wave", "Wave through the whole volume, high and low, near and far.", "", {}};
  return {"Enough", "All cameras have seen enough.", "End the wave", requestOf(Command::kStopWave)};
}

Advice Guide::complete() const {
  if (status_->wave_seconds > 0.0)
    return {"Solve", "All is captured.", "Solve", requestOf(Command::kSolve)};
  if (tried(Command::kStartWave, false))
    return {"Solve", "The square is captured.", "Solve from the square alone",
            requestOf(Command::kSolve)};
  if (isClockwise())
    return {"z is down",
            "The corners go clockwise, so z will point down. If you do not want that, start again.",
            "Go on with the wave", requestOf(Command::kStartWave)};
  return {"Wave", "Take the LED in your hand.", "Begin the wave", requestOf(Command::kStartWave)};
}

Advice Guide::solved() const {
  const auto* found = verdict();
  if (!found || found->grade != found->REDO)
    return {found && found->grade == found->GOOD ? "Good" : "Usable",
            "Read the verdict below, then save.", "Save", requestOf(Command::kSave)};
  if (found->redo_corner < 0)
    return {"Again", "Do again what the verdict below says.", "", {}};
  Request request = requestOf(Command::kCapture);
  request.corner = found->redo_corner;
  const std::string name = "corner " + std::to_string(found->redo_corner + 1);
  return {"Corner " + std::to_string(found->redo_corner + 1), "Put the LED on " + name + " again.",
          "Capture " + name + " again", request};
}

/// Whether the captured corners go round clockwise, as most cameras see them.
bool Guide::isClockwise() const {
  if (corners_.size() != 4)
    return false;
  int votes = 0;
  for (const auto& [name, first] : corners_[0]) {
    double area = 0.0;  // twice; positive clockwise, since y points down
    bool is_complete = true;
    for (std::size_t i = 0; i < 4 && is_complete; ++i) {
      const auto a = corners_[i].find(name);
      const auto b = corners_[(i + 1) % 4].find(name);
      is_complete = a != corners_[i].end() && b != corners_[(i + 1) % 4].end();
      if (is_complete)
        area += a->second.first * b->second.second - b->second.first * a->second.second;
    }
    if (is_complete)
      votes += area > 0.0 ? 1 : -1;
  }
  return votes > 0;
}

}  // namespace wiimote_tracker::panel
