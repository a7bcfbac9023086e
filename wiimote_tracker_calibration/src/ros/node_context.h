#ifndef WIIMOTE_TRACKER_CALIBRATION_ROS_NODE_CONTEXT_H
#define WIIMOTE_TRACKER_CALIBRATION_ROS_NODE_CONTEXT_H

#include "wiimote_tracker_calibration/place/known_places.h"
#include "wiimote_tracker_calibration/workflow/calibration.h"

#include "camera_inputs.h"
#include "parameters.h"
#include "rig_output.h"

#include <ros/node_handle.h>
#include <wiimote_tracker_msgs/CalibrationCameraStatus.h>

#include <condition_variable>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker {

/// What the node's units share. A unit is constructed from it, advertises its services, subscribes
/// to inputs() and lives as long as the node. Nobody holds the mutex while solving, writing files,
/// or calling a service.
///
/// Something that takes time looks like this:
///     Lock lock(context.mutex());
///     reply = context.begin(Step::kMeasuring, "keep the LED still", lock);
///     if (reply.success) {
///       context.waitUntil(&lock, context.now() + duration,
///                         [&] { return enough || context.stopped(Step::kMeasuring, lock); });
///       ...
///       context.end(reply, lock);
///     }
class NodeContext {
 public:
  NodeContext(const ros::NodeHandle& nh, const Parameters& parameters);

  ros::NodeHandle& nh() { return nh_; }
  std::mutex& mutex() { return mutex_; }

  /// Notified at each image, and by notify().
  void notify() { changed_.notify_all(); }

  /// The clock of the images' stamps: ROS time, simulated or not [s].
  static double now();

  /// Images of the last second may still be under way [s]: what is decided by their stamps must not
  /// be decided by the clock before.
  static constexpr double kUnderWay = 1.0;

  /// Waits until done() is true (checked with the mutex locked at each image, and ten times a
  /// second at least), until now() is beyond `end`, or until the node is to end. Simulated time
  /// that stands still for ten seconds, as of a bag that is over, ends the wait too.
  /// @returns done().
  bool waitUntil(Lock* lock, double end, const std::function<bool()>& done);

  CameraInputs& inputs() { return inputs_; }

  // --- All of the following with the mutex locked.

  /// A copy may be taken; a unit may change what is its own, such as a camera's intrinsics.
  Parameters& parameters(const Lock&) { return parameters_; }
  workflow::Calibration& calibration(const Lock&) { return calibration_; }
  /// Measured with the current rig after useRig(); before that perhaps with another.
  place::KnownPlaces& knownPlaces(const Lock&) { return known_places_; }

  /// See workflow::Calibration::begin(), end(). The status shows it at once.
  workflow::Reply begin(workflow::Step step, const std::string& message, const Lock& lock);
  void setProgress(double progress, const Lock&) { calibration_.setProgress(progress); }
  /// Whether what was begun is to stop. Whoever began it calls end() all the same.
  bool stopped(workflow::Step step, const Lock&) const { return !calibration_.isBusyWith(step); }
  void end(const workflow::Reply& outcome, const Lock& lock);

  /// Shows a message in the status at once.
  void show(const std::string& message, const Lock& lock);

  /// All that was captured so far, to be solved or saved. Fails, with a sentence, when starting
  /// intrinsics do not fit a camera's images.
  workflow::Reply session(session::Session* session, const Lock& lock);
  /// Goes on from what was captured before; its masks are in force from now on.
  workflow::Reply setSession(const session::Session& session, const Lock& lock);

  /// Publishes a rig that was made of the one before (not saved yet): a camera calibrated anew, a
  /// correction of the volume, rooms that were joined.
  void setRig(const geometry::Rig& rig, const std::string& message, const Lock& lock);
  /// Nothing while there is none.
  const std::optional<geometry::Rig>& rig(const Lock&) const { return calibration_.rig(); }
  /// Tells the others about the current rig.
  void publishRig(const Lock&) { rig_output_.publish(*calibration_.rig()); }

  /// Ignores other lights from now on, in the images and in the rig, which is then published.
  /// @returns whether there is a rig and it changed.
  bool setMasks(const capture::Masks& masks, const Lock& lock);

  /// CalibrationCameraStatus.health of a camera from now on; empty: all is well.
  void setHealth(const std::string& camera, const std::string& text, const Lock&);

  /// What each camera shows over the last `window` seconds, and what it has contributed so far.
  std::vector<wiimote_tracker_msgs::CalibrationCameraStatus> cameraStatus(double now,
                                                                          double window,
                                                                          const Lock&) const;

  void publishStatus(const Lock& lock);

 private:
  ros::NodeHandle nh_;
  std::mutex mutex_;
  std::condition_variable changed_;
  Parameters parameters_;
  workflow::Calibration calibration_;
  place::KnownPlaces known_places_;
  std::map<std::string, std::string> health_;
  ros::Publisher status_publisher_;
  RigOutput rig_output_;
  CameraInputs inputs_;
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_CALIBRATION_ROS_NODE_CONTEXT_H
