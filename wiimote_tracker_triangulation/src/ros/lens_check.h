#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_LENS_CHECK_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_LENS_CHECK_H

#include "wiimote_tracker_triangulation/geometry/rig.h"

#include <ros/node_handle.h>
#include <sensor_msgs/CameraInfo.h>

#include <map>
#include <string>

namespace wiimote_tracker {

/// In what a camera_info contradicts the lens that a camera was calibrated with, in one sentence;
/// empty when in nothing, or when the camera_info is that of an uncalibrated camera.
std::string contradictionOf(const sensor_msgs::CameraInfo& info,
                            const geometry::Camera& calibrated);

/// Compares what the cameras' drivers publish as camera_info with the rig, and listens to each
/// until they agree. Points are always made from the rig.
class LensCheck {
 public:
  explicit LensCheck(const ros::NodeHandle& nh) : nh_(nh) {}

  /// Compares with this rig from now on.
  void setRig(const geometry::Rig& rig);

  /// Empty when none is known.
  std::string problemOf(const std::string& camera) const;

 private:
  void compare(const sensor_msgs::CameraInfo& info, const geometry::Camera& calibrated);

  ros::NodeHandle nh_;
  std::map<std::string, ros::Subscriber> subscribers_;  // by camera
  std::map<std::string, std::string> problems_;         // by camera
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_LENS_CHECK_H
