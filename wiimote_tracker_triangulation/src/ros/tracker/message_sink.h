#pragma once

#include "wiimote_tracker_triangulation/geometry/rig.h"
#include "wiimote_tracker_triangulation/tracking/snapshot.h"

#include <wiimote_tracker_msgs/TrackedBodyArray.h>
#include <wiimote_tracker_msgs/TrackedPointArray.h>
#include <wiimote_tracker_msgs/ZoneEvent.h>

#include <string>
#include <vector>

namespace wiimote_tracker {

/// Receives the results of MessageTracker; those whose function it does not override are ignored.
class MessageSink {
 public:
  virtual ~MessageSink() = default;

  /// The LEDs at one time; times increase strictly until time jumps back. `views`: what the cameras
  /// saw. The message must not be changed.
  virtual void onPoints(const wiimote_tracker_msgs::TrackedPointArrayConstPtr& /*points*/,
                        const std::vector<tracking::CameraView>& /*views*/) {}

  /// The rigid bodies at the time of an image, before the points of that image. Times increase
  /// strictly too. None without known bodies. `bridged`: for each body of the message,
  /// whether its IMU predicts it, so that its pose is as that of a tracked one.
  virtual void onBodies(const wiimote_tracker_msgs::TrackedBodyArray& /*bodies*/,
                        const std::vector<bool>& /*bridged*/) {}

  virtual void onZoneEvent(const wiimote_tracker_msgs::ZoneEvent& /*event*/) {}

  /// The LEDs at the time of a trigger.
  virtual void onTriggeredPoints(const wiimote_tracker_msgs::TrackedPointArray& /*points*/) {}

  /// A problem: one sentence that says what to do. Faults of cameras: see FaultReports.
  virtual void onProblem(const std::string& /*sentence*/) {}
};

/// Changes snapshots before results are made of them, as a smoother does.
class SnapshotFilter {
 public:
  virtual ~SnapshotFilter() = default;

  /// The rig of all that follows.
  virtual void setRig(const geometry::Rig& rig) = 0;

  /// @returns the snapshot to use instead, with the same LEDs; valid until the next call.
  virtual const tracking::Snapshot& apply(const tracking::Snapshot& snapshot) = 0;
};

}  // namespace wiimote_tracker
