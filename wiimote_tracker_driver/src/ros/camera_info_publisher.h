#pragma once

#include "image_topic.h"
#include "protocol/calibration_blocks.h"

#include <camera_info_manager/camera_info_manager.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <sensor_msgs/CameraInfo.h>

#include <optional>
#include <string>

namespace wiimote_tracker::driver {

/// Keeps the camera's calibration (service `set_camera_info`). Publishes it as `camera_info` with
/// each image, and the factory calibration, latched, as `factory/camera_info`.
class CameraInfoPublisher {
 public:
  /// `url`: of the calibration file; empty: the default of camera_info_manager.
  /// @throws ParameterError, naming `url_parameter`, when the URL can never work.
  CameraInfoPublisher(const ros::NodeHandle& nh,
                      const std::string& camera,
                      const std::string& frame_id,
                      const std::string& url,
                      const std::string& url_parameter);

  /// What is wrong with the calibration, empty if nothing is; logged when it is new.
  /// camera_info_manager answers `set_camera_info` with success also when it saves nonsense or, on
  /// a full disk, an empty file.
  std::string problem();

  void publish(const ros::Time& stamp);

  /// Publishes the factory's principal point as cx and cy, with a focal length of 0 (unknown).
  /// Without a factory calibration K is 0.
  void publishFactory(const std::optional<protocol::IrCalibration>& calibration,
                      const ros::Time& stamp);

 private:
  std::string findProblem();

  ros::NodeHandle nh_;
  const std::string frame_id_;
  std::string path_;     // of the calibration; empty: it belongs to a package
  std::string problem_;  // as logged
  camera_info_manager::CameraInfoManager manager_;
  ImageTopic<sensor_msgs::CameraInfo> topic_;
  ros::Publisher factory_;
};

}  // namespace wiimote_tracker::driver
