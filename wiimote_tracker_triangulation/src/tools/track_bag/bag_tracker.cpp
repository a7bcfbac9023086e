#include "bag_tracker.h"

#include "wiimote_tracker_triangulation/geometry/error.h"

#include <algorithm>
#include <cstdio>

namespace wiimote_tracker {

BagTracker::BagTracker(const TrackingParameters& parameters, const Topics& topics, Results* results)
    : tracker_(parameters, this), topics_(topics), results_(results) {}

void BagTracker::takeRig(const wiimote_tracker_msgs::RigCalibration& rig,
                         const ros::Time& recorded) {
  now_ = std::max(now_, recorded);
  try {
    tracker_.takeRig(rig);
  } catch (const geometry::Error& e) {
    refusal_ = e.what();
    onProblem("a rig is refused" +
              std::string(tracker_.hasRig() ? ", the one before stays in use: " : ": ") + refusal_);
    return;
  }
  camera_of_.clear();
  for (const geometry::RigCamera& camera : tracker_.rig().cameras)
    camera_of_[topics_.blobs(camera.camera.name)] = camera.camera.name;
}

void BagTracker::takeImage(const std::string& topic,
                           const wiimote_tracker_msgs::IrBlobArray& image,
                           const ros::Time& recorded) {
  now_ = std::max(now_, recorded);
  const auto camera = camera_of_.find(topic);
  if (camera == camera_of_.end())
    return;
  ++images_used_;
  tracker_.takeImage(camera->second, image);
}

void BagTracker::takeTrigger(const std_msgs::Header& trigger, const ros::Time& recorded) {
  now_ = std::max(now_, recorded);
  tracker_.takeTrigger(trigger);
}

void BagTracker::onPoints(const wiimote_tracker_msgs::TrackedPointArrayConstPtr& points,
                          const std::vector<tracking::CameraView>&) {
  results_->addPoints(points, now_);
}

void BagTracker::onBodies(const wiimote_tracker_msgs::TrackedBodyArray& bodies) {
  results_->addBodies(bodies, now_);
}

void BagTracker::onZoneEvent(const wiimote_tracker_msgs::ZoneEvent& event) {
  results_->addZoneEvent(event, now_);
}

void BagTracker::onTriggeredPoints(const wiimote_tracker_msgs::TrackedPointArray& points) {
  results_->addTriggeredPoints(points, now_);
}

void BagTracker::onProblem(const std::string& sentence) {
  std::fprintf(stderr, "track_bag: at %.6f s: %s\n", now_.toSec(), sentence.c_str());
}

}  // namespace wiimote_tracker
