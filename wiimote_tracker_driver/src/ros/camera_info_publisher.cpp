#include "camera_info_publisher.h"

#include "wiimote_tracker_driver/protocol/input_reports.h"

#include <ros/console.h>
#include <wiimote_tracker_msgs/parameter_reader.h>

#include <exception>
#include <filesystem>
#include <system_error>

namespace wiimote_tracker::driver {
namespace {

/// Of camera_info_manager.
constexpr const char* kDefaultUrl = "file://${ROS_HOME}/camera_info/${NAME}.yaml";

/// The file that a resolved URL names; empty: it names one of a package.
std::string pathOf(const std::string& url) {
  const std::string scheme = "file://";
  return url.compare(0, scheme.size(), scheme) == 0 ? url.substr(scheme.size()) : "";
}

}  // namespace

CameraInfoPublisher::CameraInfoPublisher(const ros::NodeHandle& nh,
                                         const std::string& camera,
                                         const std::string& frame_id,
                                         const std::string& url,
                                         const std::string& url_parameter)
    : nh_(nh), frame_id_(frame_id), manager_(nh, camera, url), topic_(nh_, "camera_info") {
  if (!manager_.validateURL(url))
    throw ParameterError(url_parameter + " is '" + url +
                         "', but must be empty or a URL such as file:///path/to/camera.yaml or "
                         "package://name/camera.yaml");
  // Reports errors of the file now rather than at the first image, but not that there is none yet.
  const std::string file = manager_.resolveURL(url.empty() ? kDefaultUrl : url, camera);
  path_ = pathOf(file);
  const std::string empty = problem();
  if (!empty.empty())
    ROS_WARN("%s.", empty.c_str());
  try {
    // The first set_camera_info writes it.
    if (!path_.empty() && (!empty.empty() || !std::filesystem::exists(path_)))
      manager_.setCameraInfo(sensor_msgs::CameraInfo());
    else
      manager_.getCameraInfo();
  } catch (const std::exception& e) {  // such as of a folder
    throw ParameterError(url_parameter + ": the calibration " + file + " cannot be read (" +
                         e.what() + "): move it away or name another file");
  }
  factory_ = nh_.advertise<sensor_msgs::CameraInfo>("factory/camera_info", 1, true);
}

std::string CameraInfoPublisher::problem() const {
  std::error_code missing;
  return std::filesystem::file_size(path_, missing) == 0
             ? path_ +
                   " is empty, so the driver does not know the lens when it starts: free space on "
                   "its disk, then save the calibration again"
             : "";
}

void CameraInfoPublisher::publish(const ros::Time& stamp) {
  if (!topic_.subscribed())
    return;
  const auto message = boost::make_shared<sensor_msgs::CameraInfo>(manager_.getCameraInfo());
  message->header.stamp = stamp;
  message->header.frame_id = frame_id_;
  if (message->width == 0) {  // not calibrated yet
    message->width = protocol::kSensorWidth;
    message->height = protocol::kSensorHeight;
  }
  topic_.publish(message);
}

void CameraInfoPublisher::publishFactory(const std::optional<protocol::IrCalibration>& calibration,
                                         const ros::Time& stamp) {
  sensor_msgs::CameraInfo message;
  message.header.stamp = stamp;
  message.header.frame_id = frame_id_;
  message.width = protocol::kSensorWidth;
  message.height = protocol::kSensorHeight;
  if (calibration) {
    message.K[2] = calibration->centre()[0];
    message.K[5] = protocol::imageY(calibration->centre()[1]);
    message.K[8] = 1.0;
  }
  factory_.publish(message);
}

}  // namespace wiimote_tracker::driver
