#pragma once

#include "host_clock_check.h"
#include "lens_check.h"
#include "load_shedding.h"
#include "tracker/message_tracker.h"
#include "wiimote_tracker_triangulation/ros/steady_updater.h"

#include <ros/node_handle.h>

#include <cstddef>
#include <string>
#include <vector>

namespace wiimote_tracker {

/// Publishes on /diagnostics: one status for the tracker and one for each camera.
class TrackingDiagnostics {
 public:
  /// `tracker` and `shedding` must live longer. `clock_tolerance`: see HostClockCheck [s].
  TrackingDiagnostics(const ros::NodeHandle& nh,
                      const ros::NodeHandle& private_nh,
                      MessageTracker* tracker,
                      const LoadShedding* shedding,
                      double clock_tolerance);

  /// To be called after the tracker got a new rig.
  void setRig();

  /// Notes when an image arrived by its camera's computer, and when this process received it.
  /// `node`: its publisher.
  void addArrival(const std::string& camera,
                  const ros::Time& arrival,
                  const ros::Time& receipt,
                  const std::string& node);

  /// Publishes when due.
  void update();

 private:
  using Status = diagnostic_updater::DiagnosticStatusWrapper;

  void setCameras(const std::vector<std::string>& cameras);
  void report(Status& status);
  bool imagesCome() const;
  void reportCamera(std::size_t camera, Status& status);
  std::string clockProblem(std::size_t camera) const;
  double period() const { return (ros::SteadyTime::now() - since_).toSec(); }  ///< [s]

  MessageTracker* tracker_;
  const LoadShedding* shedding_;
  HostClockCheck clocks_;
  LensCheck lenses_;
  std::vector<std::string> cameras_;
  std::vector<std::string> nodes_;  // per camera
  SteadyUpdater updater_;
  ros::SteadyTime since_ = ros::SteadyTime::now();  // the last report
};

}  // namespace wiimote_tracker
