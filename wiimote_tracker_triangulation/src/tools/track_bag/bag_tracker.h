#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_TOOLS_TRACK_BAG_BAG_TRACKER_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_TOOLS_TRACK_BAG_BAG_TRACKER_H

#include "message_tracker.h"
#include "results.h"
#include "topics.h"

#include <ros/time.h>
#include <std_msgs/Header.h>
#include <wiimote_tracker_msgs/IrBlobArray.h>
#include <wiimote_tracker_msgs/RigCalibration.h>

#include <cstdint>
#include <map>
#include <string>

namespace wiimote_tracker {

/// Gives recorded messages to a MessageTracker, and what comes out to Results, with the recorded
/// time of the message that brought it forth, or that of an earlier one if that is later: results
/// are in the new bag in the order in which they came.
class BagTracker : private MessageSink {
 public:
  BagTracker(const TrackingParameters& parameters, const Topics& topics, Results* results);

  /// An unusable rig is refused with a sentence on the error output; the one before stays.
  void takeRig(const wiimote_tracker_msgs::RigCalibration& rig, const ros::Time& recorded);
  void takeImage(const std::string& topic,
                 const wiimote_tracker_msgs::IrBlobArray& image,
                 const ros::Time& recorded);
  void takeTrigger(const std_msgs::Header& trigger, const ros::Time& recorded);
  void finish() { tracker_.finish(); }

  bool hasRig() const { return tracker_.hasRig(); }
  const tracking::Counters& counters() const { return tracker_.counters(); }  ///< With a rig.
  std::uint64_t imagesUsed() const { return images_used_; }  ///< Of cameras of the rig.
  const std::string& refusal() const { return refusal_; }    ///< Of the last rig refused.

 private:
  void onPoints(const wiimote_tracker_msgs::TrackedPointArrayConstPtr& points,
                const std::vector<tracking::CameraView>& views) override;
  void onBodies(const wiimote_tracker_msgs::TrackedBodyArray& bodies) override;
  void onZoneEvent(const wiimote_tracker_msgs::ZoneEvent& event) override;
  void onTriggeredPoints(const wiimote_tracker_msgs::TrackedPointArray& points) override;
  void onProblem(const std::string& sentence) override;

  MessageTracker tracker_;
  Topics topics_;
  Results* results_;
  std::map<std::string, std::string> camera_of_;  // by topic
  ros::Time now_;
  std::uint64_t images_used_ = 0;
  std::string refusal_;
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_TOOLS_TRACK_BAG_BAG_TRACKER_H
