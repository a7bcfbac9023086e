#ifndef WIIMOTE_TRACKER_CALIBRATION_ROS_HEALTH_MONITOR_H
#define WIIMOTE_TRACKER_CALIBRATION_ROS_HEALTH_MONITOR_H

#include "wiimote_tracker_calibration/health/health_watch.h"

#include "node_context.h"

#include <diagnostic_updater/diagnostic_updater.h>

#include <optional>
#include <set>
#include <string>

namespace wiimote_tracker {

/// Watches the cameras of the current rig: health in the status, /diagnostics, and one warning in
/// the log when something begins; so of cameras that send images and are not in the rig. It never
/// changes the rig.
class HealthMonitor {
 public:
  explicit HealthMonitor(NodeContext* context);

 private:
  void update();
  void noticeStrangers(const geometry::Rig& rig, const Lock& lock);
  void report(diagnostic_updater::DiagnosticStatusWrapper& status);

  NodeContext& context_;
  std::string rig_id_;
  std::optional<health::HealthWatch> watch_;  // Nothing without a rig.
  std::set<std::string> strangers_;           // Cameras that the rig does not have.
  diagnostic_updater::Updater diagnostics_;
  ros::WallTimer timer_;
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_CALIBRATION_ROS_HEALTH_MONITOR_H
