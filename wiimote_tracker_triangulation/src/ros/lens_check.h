#pragma once

#include "wiimote_tracker_triangulation/geometry/rig.h"

#include <ros/node_handle.h>
#include <sensor_msgs/CameraInfo.h>

#include <map>
#include <string>

namespace wiimote_tracker {

/// How a camera_info differs from the lens that a camera was calibrated with, in one sentence;
/// empty when they agree, or when the camera_info is that of an uncalibrated camera.
std::string lensMismatch(const sensor_msgs::CameraInfo& info, const geometry::Camera& calibrated);

/// Compares the camera_info of each camera's driver with the rig until they agree. Points are
/// always computed from the rig.
class LensCheck {
 public:
  explicit LensCheck(const ros::NodeHandle& nh) : nh_(nh) {}

  /// Compares with this rig from now on, unless it was solved since this object was made: then the
  /// drivers get their lenses when it is saved.
  void setRig(const geometry::Rig& rig);

  /// Empty without a mismatch.
  std::string problemOf(const std::string& camera) const;

 private:
  void compare(const sensor_msgs::CameraInfo& info, const geometry::Camera& calibrated);

  ros::NodeHandle nh_;
  double begin_ = ros::WallTime::now().toSec();
  std::map<std::string, ros::Subscriber> subscribers_;  // by camera
  std::map<std::string, std::string> problems_;         // by camera
};

}  // namespace wiimote_tracker
