#ifndef WIIMOTE_TRACKER_CALIBRATION_ROS_RIG_STORAGE_H
#define WIIMOTE_TRACKER_CALIBRATION_ROS_RIG_STORAGE_H

#include <wiimote_tracker_triangulation/geometry/rig.h>

#include <ros/node_handle.h>
#include <sensor_msgs/CameraInfo.h>

#include <string>
#include <vector>

namespace wiimote_tracker {

/// Writes rig.yaml (the file before becomes rig.yaml.bak), and beside it one camera-info YAML per
/// camera, named after the camera. rig.yaml is the one that counts.
/// @returns warnings, one for each camera file that could not be written.
/// @throws geometry::Error: rig.yaml could not be written; nothing has changed then.
std::vector<std::string> saveRig(const geometry::Rig& rig, const std::string& path);

/// What stock ROS tools know of a camera: its name and lens.
sensor_msgs::CameraInfo cameraInfo(const geometry::Camera& camera);

/// Calls set_camera_info of a camera, and waits for its answer for at most `timeout` [s], whatever
/// the driver does. Hold no mutex.
/// @returns why the driver does not know its lens now; empty when it does.
std::string sendCameraInfo(const geometry::Camera& camera,
                           const ros::NodeHandle& nh,
                           double timeout);

/// Same for every camera of the rig, all at once.
/// @returns warnings, one for each camera that did not take it.
std::vector<std::string> sendCameraInfo(const geometry::Rig& rig,
                                        const ros::NodeHandle& nh,
                                        double timeout);

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_CALIBRATION_ROS_RIG_STORAGE_H
