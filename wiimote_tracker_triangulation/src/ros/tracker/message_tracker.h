#pragma once

#include "body/body_tracker.h"
#include "fault_reports.h"
#include "image_message.h"
#include "imu_reports.h"
#include "message_sink.h"
#include "parameters.h"
#include "point_output.h"
#include "statistics.h"
#include "wiimote_tracker_triangulation/identity/snapshot_sightings.h"

#include <sensor_msgs/Imu.h>
#include <wiimote_tracker_msgs/IrBlobArray.h>
#include <wiimote_tracker_msgs/RigCalibration.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace wiimote_tracker {

/// The tracker without a node: takes messages (rigs, images, triggers) and gives messages (points,
/// bodies, zone events, triggered points). The results are a function of the messages and their
/// order; no clock is read.
class MessageTracker {
 public:
  /// @param sink, filter must live longer; the filter may be null.
  MessageTracker(const TrackingParameters& parameters,
                 MessageSink* sink,
                 SnapshotFilter* filter = nullptr);
  MessageTracker(const MessageTracker&) = delete;
  MessageTracker& operator=(const MessageTracker&) = delete;

  /// What a new RigCalibration changed.
  struct RigChange {
    bool points = false;      ///< Anything that determines them.
    bool correction = false;  ///< The correction of the volume, which may come after its rig.
  };

  /// Takes effect at once, for all cameras. The same rig again changes nothing.
  /// @throws geometry::Error, Error; then the previous rig stays.
  RigChange takeRig(const wiimote_tracker_msgs::RigCalibration& message);

  bool hasRig() const { return estimator_ != nullptr; }
  const geometry::Rig& rig() const { return rig_; }     ///< Only with a rig.
  const std::string& rigId() const { return rig_id_; }  ///< As published.
  const VolumeCorrection& correction() const { return points_.correction(); }

  /// Calls the sink with all results of the image. An image that cannot be used, or of a camera
  /// that the rig does not have, is ignored. @returns whether it was used.
  bool takeImage(const std::string& camera, const wiimote_tracker_msgs::IrBlobArray& message);

  /// The rigid bodies to track from now on, instead of those of the parameters. Their spots do not
  /// become LEDs. @throws Error; then the previous bodies stay.
  void setBodies(const std::vector<body::Constellation>& bodies);

  /// A sample of the IMU of a body. One that cannot be used is ignored; so are all if the world's z
  /// axis does not point up.
  void takeInertial(const std::string& body, const sensor_msgs::Imu& message);

  /// Asks for the points at a trigger's time. They follow as soon as the images reach it; the
  /// arrival of the trigger does not matter.
  void takeTrigger(const std_msgs::Header& trigger) { points_.takeTrigger(trigger); }

  /// No image will follow: refuses waiting triggers.
  void finish() { points_.finish(); }

  const tracking::Counters& counters() const { return estimator_->counters(); }  ///< With a rig.
  Statistics& statistics() { return statistics_; }
  identity::LedLabels& labels() { return labels_; }

 private:
  void reportProblem(std::size_t camera, const std::string& sentence, bool is_new);
  void restart();
  void publishBodies(const body::BodySnapshot& snapshot);
  void startBodies(const tracking::Snapshot& snapshot);
  void takeSnapshot(const tracking::Snapshot& tracked);
  void forgetLamps();
  void reportDoubtfulLabels();

  TrackingParameters parameters_;
  MessageSink* sink_;
  SnapshotFilter* filter_;

  geometry::Rig rig_;
  std::string rig_id_;
  std::unique_ptr<tracking::Estimator> estimator_;    // null before the first rig
  std::unique_ptr<identity::Identifier> identifier_;  // null: no LED blinks
  identity::SnapshotSightings sightings_;
  identity::LedLabels labels_;
  body::BodyTracker bodies_;
  ImuReports imu_reports_;
  PointOutput points_;
  Statistics statistics_;
  FaultReports reported_faults_;
  bool lone_camera_ = false;  // a camera that sees no LED with another; reported
  std::uint64_t resets_ = 0;

  // Reused buffers.
  tracking::CameraImage image_;
  std::vector<body::LabelledPoint> labelled_;
  std::vector<bool> bridged_;
};

}  // namespace wiimote_tracker
