#include "rig_storage.h"

#include "file_paths.h"
#include "requests.h"

#include <wiimote_tracker_triangulation/geometry/atomic_file.h>
#include <wiimote_tracker_triangulation/geometry/error.h>
#include <wiimote_tracker_triangulation/geometry/rig_file.h>
#include <wiimote_tracker_triangulation/ros/conversions.h>

#include <ros/service.h>
#include <sensor_msgs/SetCameraInfo.h>
#include <wiimote_tracker_msgs/text.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <exception>
#include <filesystem>
#include <future>
#include <optional>
#include <regex>
#include <system_error>
#include <thread>
#include <utility>

namespace wiimote_tracker {

namespace {

std::string beside(const std::string& rig_file, const std::string& name) {
  return std::filesystem::path(rig_file).replace_filename(name).string();
}

std::string wholePath(const std::string& path) {
  return std::filesystem::absolute(path).lexically_normal().string();
}

std::string lensFile(const std::string& rig_file, const std::string& camera) {
  return beside(rig_file, geometry::withoutSlashes(camera) + ".yaml");
}

/// Paths of the rigs that keepVersion() wrote, as far as they can be listed, the oldest first.
std::vector<std::filesystem::path> versionsOf(const std::string& rig_file) {
  namespace fs = std::filesystem;
  const std::regex is_version("[0-9]{8}_[0-9]{6}_[0-9a-f]+\\.yaml");
  std::vector<fs::path> versions;
  std::error_code error;
  for (fs::directory_iterator entry(beside(rig_file, "versions"), error), end;
       !error && entry != end; entry.increment(error)) {
    if (std::regex_match(entry->path().filename().string(), is_version))
      versions.push_back(entry->path());
  }
  std::sort(versions.begin(), versions.end());
  return versions;
}

/// What is in a file; empty: there is none.
std::string contentOf(const std::string& path) {
  std::error_code error;
  return std::filesystem::exists(path, error) ? geometry::readFile(path) : "";
}

/// Nothing: there is no rig that could be lost.
std::optional<geometry::Rig> rigIn(const std::string& path) {
  try {
    return geometry::readRigFile(path);
  } catch (const Error&) {
    return std::nullopt;
  }
}

/// Why a person must know what a file holds before it is replaced; empty: it may be.
/// @param old the rig in it, if any. @param is_known whether the node read or wrote it.
std::string describeRisk(const geometry::Rig& rig,
                         const std::optional<geometry::Rig>& old,
                         const std::string& path,
                         bool is_known) {
  std::vector<std::string> cameras;
  bool are_others = old.has_value();
  for (const geometry::RigCamera& camera :
       old ? old->cameras : std::vector<geometry::RigCamera>()) {
    cameras.push_back(camera.camera.name);
    const geometry::RigCamera* same = rig.find(camera.camera.name);
    are_others &= !same || camera.camera.isOtherDevice(same->camera.identity);
  }
  const std::string of_cameras = "a rig of " + joined(cameras);
  if (!is_known)
    return path + " holds " + (old ? of_cameras : "something") +
           " that this node has neither loaded nor saved: load it, save to another file, or save "
           "again to replace it";
  if (are_others)
    return path + " holds " + of_cameras +
           ", which are other cameras: save to another file, so that each rig has a rig_file of "
           "its own, or save again to replace it";
  return "";
}

/// Names the zones that only the file has, as a person may have written them into it.
std::vector<std::string> lostZones(const geometry::Rig& rig,
                                   const std::optional<geometry::Rig>& old,
                                   const std::string& path) {
  std::vector<std::string> zones;
  for (const geometry::Zone& lost : old ? old->zones : std::vector<geometry::Zone>()) {
    if (std::none_of(rig.zones.begin(), rig.zones.end(), [&](const geometry::Zone& zone) {
          return zone.name == lost.name && zone.minimum == lost.minimum &&
                 zone.maximum == lost.maximum;
        }))
      zones.push_back(lost.name);
  }
  if (zones.empty())
    return {};
  return {"the file had other zones (" + joined(zones) + "), which are in " + path +
          ".bak until the next save: if they still hold, copy them into the file, then call "
          "calibration/load"};
}

/// Writes each camera's file. @returns warnings, one for each that could not be written.
std::vector<std::string> writeLenses(const geometry::Rig& rig, const std::string& path) {
  std::vector<std::string> warnings;
  for (const geometry::RigCamera& rig_camera : rig.cameras) {
    const geometry::Camera& camera = rig_camera.camera;
    const std::string file = lensFile(path, camera.name);
    const bool is_for_rigs = file == beside(path, kRigFile);
    if (is_for_rigs || file == beside(path, kSamplesFile)) {
      warnings.push_back(file + (is_for_rigs ? " is for rigs" : " is for samples") +
                         ", so the lens of " + camera.name + " has none: rename the camera");
      continue;
    }
    try {
      geometry::writeCameraInfoFile(camera, file);
    } catch (const geometry::Error& error) {
      warnings.emplace_back(error.what());
    }
  }
  return warnings;
}

constexpr char kNoService[] = "there is no such service";

/// @returns why the driver does not know its lens now; empty when it does.
std::string callDriver(const std::string& name,
                       const std::string& service,
                       const sensor_msgs::CameraInfo& info) {
  sensor_msgs::SetCameraInfo call;
  call.request.camera_info = info;
  if (!ros::service::exists(service, false))
    return kNoService;
  if (!ros::service::call(service, call))
    return "calling " + service +
           " failed, so the driver does not know its lens: see its log, then save again";
  return call.response.success
             ? ""
             : name + " refused its camera info (" + call.response.status_message +
                   "): see the log of its driver, then save again";
}

}  // namespace

geometry::Rig RigFiles::read(const std::string& path) {
  const std::lock_guard<std::mutex> lock(mutex_);
  known_[wholePath(path)] = contentOf(path);
  return geometry::readRigFile(path);
}

std::vector<std::string> RigFiles::save(const geometry::Rig& rig,
                                        const std::string& path,
                                        bool with_lenses) {
  for (const geometry::RigCamera& camera : rig.cameras) {
    if (lensFile(path, camera.camera.name) == path && path != beside(path, kRigFile))
      throw Refusal(path + " is for the lens of " + camera.camera.name +
                    ": save the rig by another name");
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  const std::string content = contentOf(path);
  const std::optional<geometry::Rig> old = rigIn(path);
  std::string& known = known_[wholePath(path)];
  const std::string risk = describeRisk(rig, old, path, content.empty() || content == known);
  const std::string request = rig.id() + path + content;
  if (std::exchange(refused_, "") != request && !risk.empty()) {
    refused_ = request;
    throw Refusal(risk);
  }
  geometry::writeRigFile(rig, path);
  known = contentOf(path);
  std::vector<std::string> warnings = lostZones(rig, old, path);
  if (with_lenses) {
    for (const std::string& warning : writeLenses(rig, path))
      warnings.push_back(warning);
  }
  return warnings;
}

std::string keepVersion(const geometry::Rig& rig,
                        double time,
                        const std::string& rig_file,
                        std::size_t most) {
  const std::string path =
      beside(rig_file, "versions/" + utcDate(time, "%Y%m%d_%H%M%S") + "_" + rig.id() + ".yaml");
  geometry::writeRigFile(rig, path);
  const std::vector<std::filesystem::path> versions = versionsOf(rig_file);
  std::error_code error;  // Then the next time is soon enough.
  for (std::size_t i = 0; i + most < versions.size(); ++i)
    std::filesystem::remove(versions[i], error);
  return path;
}

std::string describeEarlierRigs(const std::string& rig_file) {
  const std::string backup = rig_file + ".bak";
  std::vector<std::string> kept;
  std::error_code error;
  if (std::filesystem::exists(backup, error))
    kept.push_back(std::filesystem::path(backup).filename());
  if (!versionsOf(rig_file).empty())
    kept.emplace_back("one of versions/");
  return kept.empty()
             ? "no earlier one is kept beside " + rig_file + ": calibrate again"
             : "load an earlier rig of " + beside(rig_file, "") + ": " + joined(kept, " or ");
}

std::vector<std::string> sendCameraInfo(const std::vector<geometry::Camera>& cameras,
                                        const ros::NodeHandle& nh,
                                        double timeout) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(timeout);
  // A thread for each camera: a service call has no time-out, and the answer may never come.
  std::vector<std::future<std::string>> answers;
  for (const geometry::Camera& camera : cameras) {
    std::packaged_task<std::string()> call(
        [name = camera.name, service = nh.resolveName(camera.name + "/set_camera_info"),
         info = cameraInfo(camera)] { return callDriver(name, service, info); });
    answers.push_back(call.get_future());
    std::thread(std::move(call)).detach();
  }
  std::vector<std::string> warnings;
  std::vector<std::string> without_service;
  for (std::size_t i = 0; i < answers.size(); ++i) {
    std::string warning = cameras[i].name +
                          " does not answer set_camera_info in time: restart its driver, then "
                          "save again";
    try {
      if (answers[i].wait_until(end) == std::future_status::ready)
        warning = answers[i].get();
    } catch (const std::exception& error) {
      warning = "set_camera_info of " + cameras[i].name + " failed: " + error.what();
    }
    if (warning == kNoService)
      without_service.push_back(cameras[i].name);
    else if (!warning.empty())
      warnings.push_back(warning);
  }
  if (!without_service.empty())
    warnings.push_back("nothing offers set_camera_info of " + joined(without_service) +
                       ": if a driver does not run, start it, then save again, so that it knows "
                       "its lens");
  return warnings;
}

}  // namespace wiimote_tracker
