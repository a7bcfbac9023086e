#pragma once

#include "wiimote_tracker_triangulation/geometry/rig.h"

#include <geometry_msgs/TransformStamped.h>
#include <sensor_msgs/CameraInfo.h>
#include <wiimote_tracker_msgs/RigCalibration.h>

#include <string>
#include <vector>

namespace wiimote_tracker {

/// Message of a rig; sets id and format_version. @throws geometry::InvalidRigError.
wiimote_tracker_msgs::RigCalibration toMessage(const geometry::Rig& rig);

/// Rig of a message. @throws geometry::InvalidRigError: unknown format_version or distortion model,
/// values out of range or not finite. Error: a damaged correction of the volume.
geometry::Rig fromMessage(const wiimote_tracker_msgs::RigCalibration& message);

/// The id by which others name the rig of a message: its own, else the computed one.
std::string idOf(const wiimote_tracker_msgs::RigCalibration& message, const geometry::Rig& rig);

using geometry::opticalFrame;

/// The camera's name and lens, for the standard ROS tools.
sensor_msgs::CameraInfo cameraInfo(const geometry::Camera& camera);

/// world -> <camera>_optical_frame of every camera, for /tf_static.
std::vector<geometry_msgs::TransformStamped> staticTransforms(const geometry::Rig& rig);

}  // namespace wiimote_tracker
