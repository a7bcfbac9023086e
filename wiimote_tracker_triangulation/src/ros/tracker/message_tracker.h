#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_TRACKER_MESSAGE_TRACKER_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_TRACKER_MESSAGE_TRACKER_H

#include "body/body_follower.h"
#include "events/refusals.h"
#include "events/trigger.h"
#include "events/zone_watch.h"
#include "fault_reports.h"
#include "identity/led_labels.h"
#include "image_message.h"
#include "imu_reports.h"
#include "parameters.h"
#include "point_message.h"
#include "statistics.h"
#include "volume_correction.h"
#include "wiimote_tracker_triangulation/geometry/rig.h"
#include "wiimote_tracker_triangulation/identity/snapshot_sightings.h"
#include "wiimote_tracker_triangulation/tracking/estimator.h"

#include <sensor_msgs/Imu.h>
#include <std_msgs/Header.h>
#include <wiimote_tracker_msgs/IrBlobArray.h>
#include <wiimote_tracker_msgs/RigCalibration.h>
#include <wiimote_tracker_msgs/TrackedBodyArray.h>
#include <wiimote_tracker_msgs/TrackedPointArray.h>
#include <wiimote_tracker_msgs/ZoneEvent.h>

#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker {

/// Receives the results of MessageTracker; those whose function it does not override are ignored.
class MessageSink {
 public:
  virtual ~MessageSink() = default;

  /// The rig of all that follows.
  virtual void onRig(const geometry::Rig& /*rig*/) {}

  /// What the tracker found, before anything is made of it but labels. @returns the snapshot to use
  /// instead, with the same LEDs; valid until the next call
  virtual const tracking::Snapshot& onSnapshot(const tracking::Snapshot& snapshot) {
    return snapshot;
  }

  /// The LEDs at one time; times increase strictly until time jumps back. `views`: what the cameras
  /// saw. The message must not be changed.
  virtual void onPoints(const wiimote_tracker_msgs::TrackedPointArrayConstPtr& /*points*/,
                        const std::vector<tracking::CameraView>& /*views*/) {}

  /// The rigid bodies at the time of an image, before the points of that image. Times increase
  /// strictly too. Only while bodies are tracked. `bridged`: for each body of the message,
  /// whether its IMU predicts it, so that its pose is as that of a tracked one.
  virtual void onBodies(const wiimote_tracker_msgs::TrackedBodyArray& /*bodies*/,
                        const std::vector<bool>& /*bridged*/) {}

  virtual void onZoneEvent(const wiimote_tracker_msgs::ZoneEvent& /*event*/) {}

  /// The LEDs at the time of a trigger.
  virtual void onTriggeredPoints(const wiimote_tracker_msgs::TrackedPointArray& /*points*/) {}

  /// A problem: one sentence that says what to do. Faults of cameras: see FaultReports.
  virtual void onProblem(const std::string& /*sentence*/) {}
};

/// The tracker without a node: takes messages (rigs, images, triggers) and gives messages (points,
/// bodies, zone events, triggered points). The results are a function of the messages and their
/// order; no clock is read.
class MessageTracker {
 public:
  MessageTracker(const TrackingParameters& parameters, MessageSink* sink);

  /// What a new RigCalibration changed.
  struct RigChange {
    bool cameras = false;     ///< Anything that determines points.
    bool correction = false;  ///< The correction of the volume, which may come after its rig.
  };

  /// Takes effect at once, for all cameras. The same rig again changes nothing.
  /// @throws geometry::Error, Error; then the previous rig stays.
  RigChange takeRig(const wiimote_tracker_msgs::RigCalibration& message);

  bool hasRig() const { return estimator_ != nullptr; }
  const geometry::Rig& rig() const { return rig_; }     ///< Only with a rig.
  const std::string& rigId() const { return rig_id_; }  ///< As published.
  const VolumeCorrection& correction() const { return correction_; }

  /// Calls the sink with all results of the image. An image that cannot be used, or of a camera
  /// that the rig does not have, is ignored.
  void takeImage(const std::string& camera, const wiimote_tracker_msgs::IrBlobArray& message);

  /// The rigid bodies to track from now on, instead of those of the parameters. Their spots do not
  /// become LEDs. @throws Error; then the previous bodies stay.
  void setBodies(const std::vector<body::Constellation>& bodies);

  /// A sample of the IMU of a body. One that cannot be used is ignored; so are all if the world's z
  /// axis does not point up.
  void takeInertial(const std::string& body, const sensor_msgs::Imu& message);

  /// Asks for the points at a trigger's time. They follow as soon as the images reach it; the
  /// arrival of the trigger does not matter.
  void takeTrigger(const std_msgs::Header& trigger);

  /// No image will follow: refuses waiting triggers.
  void finish();

  const tracking::Counters& counters() const { return estimator_->counters(); }  ///< With a rig.
  Statistics& statistics() { return statistics_; }
  identity::LedLabels& labels() { return labels_; }

 private:
  void reportProblem(std::size_t camera, const std::string& sentence, bool is_new);
  void useCameras(const geometry::Rig& rig);
  void restart();
  void reportTilt();
  void publishBodies();
  void findBodiesByLabels(const tracking::Snapshot& snapshot);
  void takeSnapshot(const tracking::Snapshot& tracked);
  void reportDoubtfulLabels();
  void publishZoneEvents(const tracking::Snapshot& snapshot);
  void answerTriggers();
  void reportRefusals(double now);
  bool clocksOutputs(std::size_t camera, double arrival) const;
  void publishTicksUntil(double now);
  void publishAt(double time);
  void publish(const tracking::Snapshot& corrected);
  wiimote_tracker_msgs::TrackedPointArray messageOf(const tracking::Snapshot& corrected) const;

  TrackingParameters parameters_;
  MessageSink* sink_;

  geometry::Rig rig_;
  std::string rig_id_;
  std::map<std::string, std::size_t> camera_index_;
  std::unique_ptr<tracking::Estimator> estimator_;  // null before the first rig
  body::BodyFollower bodies_;
  ImuReports imu_reports_;
  double tilt_ = 0.0;  // of the world's z axis [rad]
  bool tilt_reported_ = false;
  bool alone_reported_ = false;  // a camera that can see no LED with another
  VolumeCorrection correction_;
  std::unique_ptr<identity::Identifier> identifier_;  // null: no LED blinks
  identity::SnapshotSightings sightings_;
  identity::LedLabels labels_;
  events::ZoneWatch zones_;
  events::Trigger trigger_;  // requests: their times [ns]
  events::Refusals refusals_;
  Statistics statistics_;
  FaultReports reported_faults_;
  std::uint64_t resets_ = 0;

  // Of the output.
  tracking::Snapshot newest_;  // corrected; time -infinity before the first
  double newest_output_ = -std::numeric_limits<double>::infinity();   // [s]
  double newest_arrival_ = -std::numeric_limits<double>::infinity();  // of used images [s]
  std::vector<bool> is_used_;                // per camera: its last image, or it had none yet
  std::optional<std::int64_t> newest_tick_;  // [1 / rate]
  std::vector<wiimote_tracker_msgs::TrackedPoint> lost_;  // LOST, not yet published

  // Reused buffers.
  std::vector<body::LabelledPoint> labelled_;
  std::vector<bool> bridged_;
  tracking::CameraImage image_;
  tracking::Snapshot corrected_;
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_TRACKER_MESSAGE_TRACKER_H
