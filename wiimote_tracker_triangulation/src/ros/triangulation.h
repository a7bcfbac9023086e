#pragma once

#include "bodies/body_diagnostics.h"
#include "bodies/body_learning.h"
#include "bodies/body_markers.h"
#include "load_shedding.h"
#include "marker_builder.h"
#include "rig_subscription.h"
#include "single_publishers.h"
#include "tracker/message_tracker.h"
#include "tracker/parameters.h"
#include "tracking_diagnostics.h"

#include <ros/ros.h>
#include <wiimote_tracker_msgs/RigCalibration.h>
#include <wiimote_tracker_msgs/SetLabel.h>

#include <future>
#include <map>
#include <set>
#include <string>
#include <system_error>
#include <vector>

namespace wiimote_tracker {

/// The tracker's topics: rig, blobs and triggers in; points, TF, markers, events and diagnostics
/// out. For node and nodelet. One thread must call all callbacks of the handles' queue, so that
/// images, rigs and triggers are handled in order of arrival.
class Triangulation : private MessageSink {
 public:
  /// @throws ParameterError.
  Triangulation(const ros::NodeHandle& nh, const ros::NodeHandle& private_nh);

 private:
  void takeRig(const wiimote_tracker_msgs::RigCalibration& message);
  void onImage(const std::string& camera,
               const ros::MessageEvent<const wiimote_tracker_msgs::IrBlobArray>& event);
  bool isShed(const ros::Time& receipt);
  bool setLabel(wiimote_tracker_msgs::SetLabel::Request& request,
                wiimote_tracker_msgs::SetLabel::Response& response);
  void onTimer();
  void keepPlaces();
  void subscribeToCameras();
  void useBodies(const std::vector<body::Constellation>& bodies);
  void subscribeToImus(const std::vector<body::Constellation>& bodies);

  void onPoints(const wiimote_tracker_msgs::TrackedPointArrayConstPtr& points,
                const std::vector<tracking::CameraView>& views) override;
  void onBodies(const wiimote_tracker_msgs::TrackedBodyArray& bodies,
                const std::vector<bool>& bridged) override;
  void onZoneEvent(const wiimote_tracker_msgs::ZoneEvent& event) override {
    zone_publisher_.publish(event);
  }
  void onTriggeredPoints(const wiimote_tracker_msgs::TrackedPointArray& points) override {
    triggered_publisher_.publish(points);
  }
  void onProblem(const std::string& sentence) override { ROS_WARN("%s.", sentence.c_str()); }

  ros::NodeHandle nh_;
  TrackingParameters parameters_;
  MessageTracker tracker_;
  MarkerBuilder markers_;
  SinglePublishers single_publishers_;
  BodyMarkers body_markers_;
  BodyDiagnostics body_diagnostics_;
  BodyLearning learning_;
  LoadShedding shedding_;
  TrackingDiagnostics diagnostics_;
  std::set<std::string> warned_of_;              // sentences about bodies
  bool former_places_read_ = false;              // of labels, from a process before
  std::future<std::error_code> writing_places_;  // as writePlaces(); invalid: none is on its way
  int seconds_without_rig_ = 0;
  bool is_calibrating_ = false;

  ros::Publisher points_publisher_;
  ros::Publisher bodies_publisher_;
  ros::Publisher markers_publisher_;
  ros::Publisher zone_publisher_;
  ros::Publisher triggered_publisher_;
  RigSubscription rig_subscription_;
  ros::Subscriber status_subscription_;  // of the calibration; while there is no rig
  ros::Subscriber trigger_subscriber_;
  std::map<std::string, ros::Subscriber> image_subscribers_;  // by camera
  std::map<std::string, ros::Subscriber> imu_subscribers_;    // by body
  ros::ServiceServer set_label_;
  ros::WallTimer timer_;
};

}  // namespace wiimote_tracker
