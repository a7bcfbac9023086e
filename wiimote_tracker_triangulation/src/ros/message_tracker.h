#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_MESSAGE_TRACKER_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_MESSAGE_TRACKER_H

#include "image_message.h"
#include "led_labels.h"
#include "parameters.h"
#include "point_message.h"
#include "statistics.h"
#include "volume_correction.h"
#include "wiimote_tracker_triangulation/body/body_follower.h"
#include "wiimote_tracker_triangulation/events/trigger.h"
#include "wiimote_tracker_triangulation/events/zone_watch.h"
#include "wiimote_tracker_triangulation/geometry/rig.h"
#include "wiimote_tracker_triangulation/identity/snapshot_sightings.h"
#include "wiimote_tracker_triangulation/tracking/estimator.h"

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
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace wiimote_tracker {

/// Takes what MessageTracker has to say.
class MessageSink {
 public:
  virtual ~MessageSink() = default;

  /// The LEDs of one time, in strictly increasing time, but for a jump back of all time. `views`:
  /// what the cameras saw. The message must never be changed.
  virtual void onPoints(const wiimote_tracker_msgs::TrackedPointArrayConstPtr& points,
                        const std::vector<tracking::CameraView>& views) = 0;

  /// The rigid bodies at the time of an image, in strictly increasing time as well; before the
  /// points of that image. Only while there are bodies to be followed.
  virtual void onBodies(const wiimote_tracker_msgs::TrackedBodyArray& /*bodies*/) {}

  virtual void onZoneEvent(const wiimote_tracker_msgs::ZoneEvent& event) = 0;

  /// The LEDs at the time of a trigger.
  virtual void onTriggeredPoints(const wiimote_tracker_msgs::TrackedPointArray& points) = 0;

  /// Something is wrong: one sentence that says what to do. Each fault of a camera comes once per
  /// rig.
  virtual void onProblem(const std::string& sentence) = 0;
};

/// The tracker in messages, without a node: rigs, images and triggers in; points, zone events
/// and triggered points out. What comes out is a function of the messages that went in and of their
/// order; no clock is read.
class MessageTracker {
 public:
  MessageTracker(const TrackingParameters& parameters, MessageSink* sink);

  /// What a new RigCalibration changed.
  struct RigChange {
    bool cameras = false;     ///< What determines points.
    bool correction = false;  ///< Of the volume. It may come later than the rig it belongs to.
  };

  /// Takes effect at once, for all cameras. The same rig again changes nothing.
  /// @throws geometry::Error, remap::RemapError; then the rig before stays.
  RigChange takeRig(const wiimote_tracker_msgs::RigCalibration& message);

  bool hasRig() const { return estimator_ != nullptr; }
  const geometry::Rig& rig() const { return rig_; }     ///< Only with a rig.
  const std::string& rigId() const { return rig_id_; }  ///< As published.
  const VolumeCorrection& correction() const { return correction_; }

  /// Calls the sink for all that follows from the image. An image that cannot be used, and one of a
  /// camera that the rig does not have, is left out.
  void takeImage(const std::string& camera, const wiimote_tracker_msgs::IrBlobArray& message);

  /// The rigid bodies to be followed from now on; first those of the parameters. Their spots do not
  /// become LEDs. @throws body::BodyError; then those before stay.
  void setBodies(const std::vector<body::Constellation>& bodies);

  /// "It happened at this time": answered as soon as the images reach beyond it. When it is asked
  /// changes nothing in the answer.
  void takeTrigger(const std_msgs::Header& trigger);

  /// No image will follow: triggers that still wait are refused.
  void finish();

  const tracking::Counters& counters() const { return estimator_->counters(); }  ///< With a rig.
  Statistics& statistics() { return statistics_; }

 private:
  void noticeFault(std::size_t camera,
                   ImageFault fault,
                   const wiimote_tracker_msgs::IrBlobArray& message);
  void startAnew();
  void publishBodies();
  void findBodiesByLabels(const tracking::Snapshot& snapshot);
  void takeSnapshot(const tracking::Snapshot& snapshot);
  void publishZoneEvents(const tracking::Snapshot& snapshot);
  void answerTriggers();
  void publishTicksUntil(double now);
  void publishPredicted(double time);
  void publish(const CorrectedSnapshot& corrected);
  wiimote_tracker_msgs::TrackedPointArray messageOf(const CorrectedSnapshot& corrected) const;

  TrackingParameters parameters_;
  MessageSink* sink_;

  geometry::Rig rig_;
  std::string computed_id_;
  std::string rig_id_;
  std::map<std::string, std::size_t> camera_index_;
  std::unique_ptr<tracking::Estimator> estimator_;  // null before the first rig
  body::BodyFollower bodies_;
  VolumeCorrection correction_;
  std::unique_ptr<identity::Identifier> identifier_;  // null: no LED blinks
  identity::SnapshotSightings sightings_;
  LedLabels labels_;
  events::ZoneWatch zones_;
  events::Trigger trigger_;
  std::map<std::uint64_t, std_msgs::Header> triggers_;  // that wait, by number
  std::uint64_t next_trigger_ = 0;
  Statistics statistics_;
  std::set<std::pair<std::size_t, ImageFault>> noticed_;  // of this rig's cameras
  std::uint64_t resets_ = 0;

  // Of the output.
  CorrectedSnapshot newest_;                                         // at no time before the first
  double newest_output_ = -std::numeric_limits<double>::infinity();  // [s]
  std::optional<std::int64_t> newest_tick_;                          // [1 / rate]
  std::vector<wiimote_tracker_msgs::TrackedPoint> lost_;             // not yet published as such

  // Reused.
  std::vector<body::LabelledPoint> labelled_;
  tracking::CameraImage image_;
  tracking::Snapshot predicted_;
  CorrectedSnapshot corrected_;
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_MESSAGE_TRACKER_H
