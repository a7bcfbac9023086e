#include "rig_storage.h"

#include <wiimote_tracker_triangulation/geometry/error.h>
#include <wiimote_tracker_triangulation/geometry/rig_file.h>
#include <wiimote_tracker_triangulation/ros/conversions.h>

#include <ros/service.h>
#include <sensor_msgs/SetCameraInfo.h>
#include <sensor_msgs/distortion_models.h>

#include <algorithm>

namespace wiimote_tracker {

namespace {

std::string cameraFile(const std::string& rig_file, const std::string& camera) {
  std::string name = camera;
  name.erase(0, name.find_first_not_of('/'));
  std::replace(name.begin(), name.end(), '/', '_');
  const std::size_t slash = rig_file.rfind('/');
  return (slash == std::string::npos ? "" : rig_file.substr(0, slash + 1)) + name + ".yaml";
}

sensor_msgs::CameraInfo cameraInfo(const geometry::Camera& camera) {
  const geometry::Intrinsics& lens = camera.intrinsics;
  sensor_msgs::CameraInfo info;
  info.header.frame_id = opticalFrame(camera.name);
  info.width = static_cast<std::uint32_t>(lens.width);
  info.height = static_cast<std::uint32_t>(lens.height);
  info.distortion_model = sensor_msgs::distortion_models::PLUMB_BOB;
  info.D.assign(lens.distortion.begin(), lens.distortion.end());
  info.K = {lens.fx, 0.0, lens.cx, 0.0, lens.fy, lens.cy, 0.0, 0.0, 1.0};
  info.R = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
  info.P = {lens.fx, 0.0, lens.cx, 0.0, 0.0, lens.fy, lens.cy, 0.0, 0.0, 0.0, 1.0, 0.0};
  return info;
}

}  // namespace

std::vector<std::string> saveRig(const geometry::Rig& rig, const std::string& path) {
  geometry::writeRigFile(rig, path);
  std::vector<std::string> warnings;
  for (const geometry::RigCamera& rig_camera : rig.cameras) {
    const geometry::Camera& camera = rig_camera.camera;
    try {
      geometry::writeCameraInfoFile(camera, cameraFile(path, camera.name));
    } catch (const geometry::Error& error) {
      warnings.emplace_back(error.what());
    }
  }
  return warnings;
}

std::vector<std::string> sendCameraInfo(const geometry::Rig& rig, const ros::NodeHandle& nh) {
  std::vector<std::string> warnings;
  for (const geometry::RigCamera& rig_camera : rig.cameras) {
    const geometry::Camera& camera = rig_camera.camera;
    const std::string service = nh.resolveName(camera.name + "/set_camera_info");
    sensor_msgs::SetCameraInfo call;
    call.request.camera_info = cameraInfo(camera);
    if (!ros::service::exists(service, false))
      warnings.push_back(camera.name + " offers no set_camera_info, so its driver does not know");
    else if (!ros::service::call(service, call))
      warnings.push_back("calling " + service + " failed, so the driver does not know");
    else if (!call.response.success)
      warnings.push_back(camera.name + " refused its camera info: " + call.response.status_message);
  }
  return warnings;
}

}  // namespace wiimote_tracker
