#include "tracker_view.h"

#include <wiimote_tracker_msgs/text.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <tuple>

namespace wiimote_tracker::panel {
namespace {

constexpr std::size_t kMostNamed = 3;

/// wiimote_2 before wiimote_10: the name without the digits at its end, and their number.
auto sortKey(const std::string& name) {
  std::size_t digits = name.size();
  while (digits > 0 && std::isdigit(static_cast<unsigned char>(name[digits - 1])))
    --digits;
  return std::make_tuple(name.substr(0, digits), name.size(), name);
}

/// What follows the number of cameras in this state.
const char* countedAs(CameraState state) {
  return state == CameraState::kFrozen          ? "without images"
         : state == CameraState::kKnocked       ? "changed since the calibration"
         : state == CameraState::kWarned        ? "with a warning of the tracker"
         : state == CameraState::kLate          ? "late"
         : state == CameraState::kNotCalibrated ? "not calibrated"
         : state == CameraState::kBlind         ? "without spots"
         : state == CameraState::kFine          ? "fine"
                                                : "unknown";
}

}  // namespace

CameraView& TrackerView::camera(const std::string& name, double now) {
  const auto place = std::lower_bound(cameras_.begin(), cameras_.end(), name,
                                      [](const CameraView& camera, const std::string& name) {
                                        return sortKey(camera.name) < sortKey(name);
                                      });
  if (place != cameras_.end() && place->name == name)
    return *place;
  return *cameras_.insert(place, CameraView(name, now));
}

void TrackerView::onTopics(const std::set<std::string>& cameras, double now) {
  for (const std::string& name : cameras)
    camera(name, now);
  cameras_.erase(std::remove_if(cameras_.begin(), cameras_.end(),
                                [&](const CameraView& camera) {
                                  return cameras.count(camera.name) == 0 &&
                                         camera.status.name.empty() && !camera.calibration &&
                                         camera.silence(now) > kForgetAfter;
                                }),
                 cameras_.end());
}

void TrackerView::onImage(const std::string& name,
                          const wiimote_tracker_msgs::IrBlobArray& message,
                          double delay,
                          double now) {
  camera(name, now).onImage(message, delay, now);
}

void TrackerView::onBattery(const std::string& name, double charge, double now) {
  camera(name, now).battery = charge;
}

void TrackerView::onStatus(const wiimote_tracker_msgs::CalibrationStatus& message, double now) {
  for (CameraView& camera : cameras_)
    camera.status = {};
  for (const auto& status : message.cameras)
    camera(status.name, now).status = status;
}

void TrackerView::onRig(const wiimote_tracker_msgs::RigCalibration& message, double now) {
  has_rig_ = true;
  rig_id_ = message.id;
  for (CameraView& camera : cameras_)
    camera.calibration.reset();
  for (const auto& calibration : message.cameras)
    camera(calibration.name, now).calibration = calibration;
}

void TrackerView::onDiagnostics(const diagnostic_msgs::DiagnosticArray& message, double now) {
  for (const diagnostic_msgs::DiagnosticStatus& status : message.status) {
    if (status.hardware_id != "rig " + rig_id_)  // such as of another room
      continue;
    // Of the tracker, a part for each camera: "NODE: CAMERA".
    for (CameraView& camera : cameras_) {
      if (status.name.substr(status.name.rfind(' ') + 1) == camera.name)
        camera.onTrackerStatus(status.level == status.OK ? "" : status.message, now);
    }
  }
}

bool TrackerView::othersSee(const CameraView& camera, double now) const {
  return std::any_of(cameras_.begin(), cameras_.end(), [&](const CameraView& other) {
    return other.name != camera.name && other.seesSpot(now);
  });
}

std::string TrackerView::summary(double now) const {
  if (cameras_.empty())
    return "No camera is there: start the drivers.";
  std::map<CameraState, std::vector<std::string>> groups;
  for (const CameraView& camera : cameras_)
    groups[stateOf(camera, now)].push_back(camera.name);
  std::string text;
  for (const auto& [state, names] : groups) {
    text += (text.empty() ? "" : ", ") + std::to_string(names.size()) + " " + countedAs(state);
    // Among many tiles nobody finds the one.
    if (names.size() <= kMostNamed && names.size() < cameras_.size() &&
        state != CameraState::kFine && state != CameraState::kNotCalibrated)
      text += " (" + joined(names) + ")";
  }
  return counted(cameras_.size(), "camera") + ": " + text +
         (has_rig_ ? "" : ". Open the page Calibrate.");
}

}  // namespace wiimote_tracker::panel
