#pragma once

#include "camera_view.h"

#include <diagnostic_msgs/DiagnosticArray.h>
#include <wiimote_tracker_msgs/CalibrationStatus.h>
#include <wiimote_tracker_msgs/RigCalibration.h>

#include <set>
#include <string>
#include <vector>

namespace wiimote_tracker::panel {

/// All cameras, from messages and times of one steady clock [s]. Uses no node, no clock and no
/// widget.
class TrackerView {
 public:
  static constexpr double kForgetAfter = 10.0;  ///< A camera that nobody names is dropped [s].

  /// The cameras whose image topic exists.
  void onTopics(const std::set<std::string>& cameras, double now);

  /// @param delay from the exposure, as stamped, to the arrival here [s]
  void onImage(const std::string& camera,
               const wiimote_tracker_msgs::IrBlobArray& message,
               double delay,
               double now);
  void onBattery(const std::string& camera, double charge, double now);
  void onStatus(const wiimote_tracker_msgs::CalibrationStatus& message, double now);
  void onRig(const wiimote_tracker_msgs::RigCalibration& message, double now);
  void onDiagnostics(const diagnostic_msgs::DiagnosticArray& message, double now);

  /// In the order of their names; numbers in names count as numbers.
  const std::vector<CameraView>& cameras() const { return cameras_; }

  /// Whether a camera other than this one has a spot.
  bool othersSee(const CameraView& camera, double now) const;

  CameraState stateOf(const CameraView& camera, double now) const {
    return camera.state(now, othersSee(camera, now));
  }
  std::string wordsOf(const CameraView& camera, double now) const {
    return camera.words(now, othersSee(camera, now));
  }

  /// The whole rig in one sentence: what is wrong first.
  std::string summary(double now) const;

 private:
  CameraView& camera(const std::string& name, double now);

  std::vector<CameraView> cameras_;
  bool has_rig_ = false;
  std::string rig_id_;
};

}  // namespace wiimote_tracker::panel
