#include "rig_storage.h"

#include <wiimote_tracker_triangulation/geometry/error.h>
#include <wiimote_tracker_triangulation/geometry/rig_file.h>
#include <wiimote_tracker_triangulation/ros/conversions.h>

#include <ros/service.h>
#include <sensor_msgs/SetCameraInfo.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <future>
#include <thread>
#include <utility>

namespace wiimote_tracker {

namespace {

std::string cameraFile(const std::string& rig_file, const std::string& camera) {
  std::string name = camera;
  name.erase(0, name.find_first_not_of('/'));
  std::replace(name.begin(), name.end(), '/', '_');
  const std::size_t slash = rig_file.rfind('/');
  return (slash == std::string::npos ? "" : rig_file.substr(0, slash + 1)) + name + ".yaml";
}

using Answer = std::future<std::string>;

/// Asks in a thread of its own: a service call has no time-out, and may be answered never.
Answer askDriver(const geometry::Camera& camera, const ros::NodeHandle& nh) {
  std::promise<std::string> promise;
  Answer answer = promise.get_future();
  std::thread(
      [name = camera.name, info = cameraInfo(camera),
       service =
           nh.resolveName(camera.name + "/set_camera_info")](std::promise<std::string> result) {
        sensor_msgs::SetCameraInfo call;
        call.request.camera_info = info;
        if (!ros::service::exists(service, false))
          result.set_value(name + " offers no set_camera_info, so its driver does not know");
        else if (!ros::service::call(service, call))
          result.set_value("calling " + service + " failed, so the driver does not know");
        else if (!call.response.success)
          result.set_value(name + " refused its camera info: " + call.response.status_message);
        else
          result.set_value("");
      },
      std::move(promise))
      .detach();
  return answer;
}

std::string answerUntil(Answer* answer,
                        const std::string& camera,
                        std::chrono::steady_clock::time_point end) {
  if (answer->wait_until(end) == std::future_status::ready)
    return answer->get();
  return camera + " does not answer set_camera_info in time: restart its driver, then save again";
}

std::chrono::steady_clock::time_point endOf(double timeout) {
  return std::chrono::steady_clock::now() +
         std::chrono::duration_cast<std::chrono::steady_clock::duration>(
             std::chrono::duration<double>(timeout));
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

sensor_msgs::CameraInfo cameraInfo(const geometry::Camera& camera) {
  const geometry::Intrinsics& lens = camera.intrinsics;
  sensor_msgs::CameraInfo info;
  info.header.frame_id = opticalFrame(camera.name);
  info.width = static_cast<std::uint32_t>(lens.width);
  info.height = static_cast<std::uint32_t>(lens.height);
  info.distortion_model = geometry::nameOf(lens.distortion_model);
  const auto count = static_cast<std::ptrdiff_t>(geometry::coefficientCount(lens.distortion_model));
  info.D.assign(lens.distortion.begin(), lens.distortion.begin() + count);
  info.K = {lens.fx, 0.0, lens.cx, 0.0, lens.fy, lens.cy, 0.0, 0.0, 1.0};
  info.R = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
  info.P = {lens.fx, 0.0, lens.cx, 0.0, 0.0, lens.fy, lens.cy, 0.0, 0.0, 0.0, 1.0, 0.0};
  return info;
}

std::string sendCameraInfo(const geometry::Camera& camera,
                           const ros::NodeHandle& nh,
                           double timeout) {
  Answer answer = askDriver(camera, nh);
  return answerUntil(&answer, camera.name, endOf(timeout));
}

std::vector<std::string> sendCameraInfo(const geometry::Rig& rig,
                                        const ros::NodeHandle& nh,
                                        double timeout) {
  const std::chrono::steady_clock::time_point end = endOf(timeout);
  std::vector<Answer> answers;
  for (const geometry::RigCamera& camera : rig.cameras)
    answers.push_back(askDriver(camera.camera, nh));
  std::vector<std::string> warnings;
  for (std::size_t i = 0; i < answers.size(); ++i) {
    const std::string warning = answerUntil(&answers[i], rig.cameras[i].camera.name, end);
    if (!warning.empty())
      warnings.push_back(warning);
  }
  return warnings;
}

}  // namespace wiimote_tracker
