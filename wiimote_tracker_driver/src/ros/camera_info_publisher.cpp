#include "camera_info_publisher.h"

#include "wiimote_tracker_driver/protocol/input_reports.h"

#include <ros/console.h>
#include <wiimote_tracker_msgs/parameter_reader.h>
#include <wiimote_tracker_msgs/text.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <filesystem>
#include <set>
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

template <typename Numbers>
bool areFinite(const Numbers& numbers) {
  return std::all_of(numbers.begin(), numbers.end(), [](double n) { return std::isfinite(n); });
}

/// Why this cannot be the calibration of the remote's camera; empty: it can, or is none yet.
std::string faultOf(const sensor_msgs::CameraInfo& info) {
  static const std::set<std::string> kModels = {"", "plumb_bob", "rational_polynomial",
                                                "equidistant"};
  if (std::count(info.K.begin(), info.K.end(), 0.0) == 9)
    return "";
  if (info.width != protocol::kSensorWidth || info.height != protocol::kSensorHeight)
    return format("its image has %u x %u pixels instead of %d x %d", info.width, info.height,
                  static_cast<int>(protocol::kSensorWidth),
                  static_cast<int>(protocol::kSensorHeight));
  if (!areFinite(info.K) || !(info.K[0] > 0.0 && info.K[4] > 0.0))
    return "K must have numbers, and the focal lengths K[0] and K[4] must be above 0";
  if (!areFinite(info.D) || !areFinite(info.R) || !areFinite(info.P))
    return "D, R and P must have numbers";
  if (kModels.count(info.distortion_model) == 0)
    return "its distortion model '" + validUtf8(info.distortion_model) + "' is unknown";
  return "";
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
  std::error_code missing;
  try {
    // The first set_camera_info writes it.
    if (!path_.empty() &&
        (!std::filesystem::exists(path_) || std::filesystem::file_size(path_, missing) == 0))
      manager_.setCameraInfo(sensor_msgs::CameraInfo());
    else
      manager_.getCameraInfo();
  } catch (const std::exception& e) {  // such as of a folder
    throw ParameterError(url_parameter + ": the calibration " + file + " cannot be read (" +
                         e.what() + "): move it away or name another file");
  }
  factory_ = nh_.advertise<sensor_msgs::CameraInfo>("factory/camera_info", 1, true);
  problem();
}

std::string CameraInfoPublisher::problem() {
  const std::string found = findProblem();
  if (found != problem_ && !found.empty())
    ROS_WARN("%s.", found.c_str());
  return problem_ = found;
}

std::string CameraInfoPublisher::findProblem() {
  std::error_code missing;
  const auto size = std::filesystem::file_size(path_, missing);
  if (size == 0)
    return path_ +
           " is empty, so the driver does not know the lens when it starts: free space on its "
           "disk, then save the calibration again";
  const sensor_msgs::CameraInfo info = manager_.getCameraInfo();
  std::string fault = faultOf(info);
  if (!missing && info.width == 0 && fault.empty())
    fault = "none can be read from it";
  if (fault.empty())
    return "";
  return "the camera's calibration " + (path_.empty() ? "" : path_ + " ") +
         "is unusable: " + fault +
         ", so camera_info has none: calibrate the camera and save it, or correct the file and "
         "start the driver again";
}

void CameraInfoPublisher::publish(const ros::Time& stamp) {
  if (!topic_.subscribed())
    return;
  const auto message = boost::make_shared<sensor_msgs::CameraInfo>(manager_.getCameraInfo());
  if (!faultOf(*message).empty())
    *message = sensor_msgs::CameraInfo();
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
