#ifndef WIIMOTE_TRACKER_CALIBRATION_ROS_HEALTH_MONITOR_H
#define WIIMOTE_TRACKER_CALIBRATION_ROS_HEALTH_MONITOR_H

#include "health/health_watch.h"

#include "node_context.h"

#include <diagnostic_updater/diagnostic_updater.h>

#include <optional>
#include <set>
#include <string>

namespace wiimote_tracker {

/// Reports cameras of the current rig that were moved, and cameras that it lacks: in the status, in
/// /diagnostics, and once in the log. It never changes the rig.
class HealthMonitor {
 public:
  explicit HealthMonitor(NodeContext* context);

 private:
  void update();
  void warnOfUnknownCameras(const geometry::Rig& rig, const Lock& lock);
  void report(diagnostic_updater::DiagnosticStatusWrapper& status);

  NodeContext& context_;
  std::string rig_id_;
  std::optional<health::HealthWatch> watch_;  // Nothing without a rig.
  std::set<std::string> unknown_cameras_;     // Cameras that the rig does not have.
  diagnostic_updater::Updater diagnostics_;
  ros::WallTimer timer_;
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_CALIBRATION_ROS_HEALTH_MONITOR_H
