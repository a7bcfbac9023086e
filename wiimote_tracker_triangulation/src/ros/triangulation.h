#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_TRIANGULATION_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_TRIANGULATION_H

#include "marker_builder.h"
#include "parameters.h"
#include "point_message.h"
#include "statistics.h"
#include "volume_correction.h"
#include "wiimote_tracker_triangulation/fusion/instant_fuser.h"

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/ros.h>
#include <tf2_ros/transform_broadcaster.h>
#include <wiimote_tracker_msgs/IrBlobArray.h>
#include <wiimote_tracker_msgs/RigCalibration.h>

#include <map>
#include <memory>
#include <string>

namespace wiimote_tracker {

/// ROS side of the fusion: blobs and rig in, points, TF and markers out. Node and nodelet are two
/// mains over this class. All callbacks must come from one thread.
class Triangulation {
 public:
  /// @throws ParameterError.
  Triangulation(const ros::NodeHandle& nh, const ros::NodeHandle& private_nh);

 private:
  void onRig(const wiimote_tracker_msgs::RigCalibrationConstPtr& message);
  void takeRig(const geometry::Rig& rig, const std::string& published_id);
  void takeCorrection(const geometry::Rig& rig);
  void onBlobs(const wiimote_tracker_msgs::IrBlobArrayConstPtr& message, const std::string& camera);
  bool isUsable(const wiimote_tracker_msgs::IrBlobArray& message,
                const geometry::RigCamera& camera) const;
  void checkIdentity(const wiimote_tracker_msgs::IrBlobArray& message, std::size_t camera);
  void publish(const fusion::Instant& measured);
  void onTimer(const ros::WallTimerEvent& event);
  void report(diagnostic_updater::DiagnosticStatusWrapper& status);

  ros::NodeHandle nh_;
  TriangulationParameters parameters_;

  geometry::Rig rig_;
  std::string computed_id_;  // of rig_; empty before the first
  std::map<std::string, std::size_t> camera_index_;
  std::vector<std::string> strangers_;  // per camera: device that was not calibrated, or empty
  std::unique_ptr<fusion::InstantFuser> fuser_;
  VolumeCorrection correction_;
  fusion::Instant corrected_;  // reused
  PointContext context_;
  double newest_instant_ = -std::numeric_limits<double>::infinity();
  double first_seen_ = std::numeric_limits<double>::quiet_NaN();
  std::uint64_t resets_ = 0;
  fusion::CameraImage image_;  // reused

  MarkerBuilder markers_;
  Statistics statistics_;
  ros::WallTime statistics_since_ = ros::WallTime::now();
  diagnostic_updater::Updater diagnostics_;

  ros::Publisher points_publisher_;
  ros::Publisher point_publisher_;
  ros::Publisher markers_publisher_;
  tf2_ros::TransformBroadcaster transforms_;
  ros::Subscriber rig_subscriber_;
  std::map<std::string, ros::Subscriber> blob_subscribers_;
  ros::WallTimer timer_;
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_TRIANGULATION_H
