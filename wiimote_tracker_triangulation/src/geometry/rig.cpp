#include "wiimote_tracker_triangulation/geometry/rig.h"

#include "wiimote_tracker_triangulation/geometry/camera_parameters.h"
#include "wiimote_tracker_triangulation/geometry/error.h"

#include <wiimote_tracker_msgs/free_name.h>
#include <wiimote_tracker_msgs/text.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace wiimote_tracker::geometry {
namespace {

void require(bool good, const std::string& message) {
  if (!good)
    throw InvalidRigError(message);
}

void checkPose(const Eigen::Isometry3d& pose) {
  require(pose.matrix().allFinite(), "its pose is not finite; calibrate again");
  const Eigen::Matrix3d rotation = pose.linear();
  require((rotation * rotation.transpose()).isIdentity(1e-6) && rotation.determinant() > 0.0,
          "its orientation is not a rotation; calibrate again");
}

void checkCamera(const RigCamera& rig_camera) {
  const Camera& camera = rig_camera.camera;
  camera.intrinsics.check();
  checkPose(camera.world_from_camera);
  if (rig_camera.time_offset_rule != TimeOffsetRule::kNone)
    require(std::isfinite(rig_camera.time_offset), "its time_offset is not finite");
  if (rig_camera.gravity)
    require(rig_camera.gravity->allFinite(), "its gravity is not finite");
  for (const ImageMask& mask : rig_camera.masks) {
    require(mask.center.allFinite() && std::isfinite(mask.radius) && mask.radius > 0.0,
            "a mask needs a finite centre and a radius above 0 px");
  }
}

}  // namespace

bool isMasked(const std::vector<ImageMask>& masks, const Eigen::Vector2d& pixel) {
  return std::any_of(masks.begin(), masks.end(), [&](const ImageMask& mask) {
    return (pixel - mask.center).norm() <= mask.radius;
  });
}

std::optional<double> RigCamera::timeOffsetIn(std::uint32_t clock_epoch) const {
  if (time_offset_rule == TimeOffsetRule::kNone || hasNewClock(clock_epoch))
    return std::nullopt;
  return time_offset;
}

double pixelNoise(const RigCamera& camera, bool use_learnt, double pixel_stddev) {
  constexpr std::uint32_t kMany = 100;
  if (!use_learnt || camera.inliers < kMany || !std::isfinite(camera.residual_px))
    return pixel_stddev;
  return std::clamp(camera.residual_px / std::sqrt(2.0), 0.1, 2.0);
}

const RigCamera* Rig::find(const std::string& name) const {
  const auto it = std::find_if(cameras.begin(), cameras.end(),
                               [&](const RigCamera& c) { return c.camera.name == name; });
  return it == cameras.end() ? nullptr : &*it;
}

Camera Rig::rayCamera(const RigCamera& rig_camera) const {
  Camera camera = rig_camera.camera;
  if (ray_model == RayModel::kCalibrated)
    return camera;
  Intrinsics& intrinsics = camera.intrinsics;
  intrinsics.distortion = {};
  intrinsics.distortion_model = DistortionModel::kPlumbBob;
  intrinsics.cx = 0.5 * intrinsics.width;
  intrinsics.cy = 0.5 * intrinsics.height;
  if (!std::isnan(virtual_hfov))
    intrinsics.fx = intrinsics.fy = 0.5 * intrinsics.width / std::tan(0.5 * virtual_hfov);
  return camera;
}

std::vector<Camera> Rig::rayCameras() const {
  std::vector<Camera> result;
  for (const RigCamera& camera : cameras)
    result.push_back(rayCamera(camera));
  return result;
}

std::vector<std::string> Rig::frames() const {
  std::vector<std::string> frames{world_frame, world_frame + "_square"};
  for (const RigCamera& camera : cameras) {
    frames.push_back(opticalFrame(camera.camera.name));
    frames.push_back(withoutSlashes(camera.camera.name) + "_imu_frame");
  }
  return frames;
}

std::string Rig::describeFarCamera() const {
  for (const RigCamera& camera : cameras) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const RigCamera& other : cameras) {
      if (&other != &camera)
        nearest = std::min(nearest, (other.camera.center() - camera.camera.center()).norm());
    }
    if (std::isfinite(nearest) && nearest > 2.0 * kFarthestLed)
      return format(
          "%s is %.0f m from the nearest other camera, but Wii Remotes that see the same LED are "
          "at most %g m apart: give its translation in metres, or calibrate again",
          camera.camera.name.c_str(), nearest, 2.0 * kFarthestLed);
  }
  return "";
}

void Rig::check() const {
  require(!cameras.empty(), "the rig has no camera; calibrate at least two");
  require(!world_frame.empty(), "the rig has no world frame; name one, e.g. world");
  require(solved_at >= 0.0 && solved_at < 4294967295.0,
          "solved_at must be a time from 0 to 4294967295 s after 1970, as ROS can represent it");
  require(std::isnan(virtual_hfov) || (virtual_hfov > 0.0 && virtual_hfov < M_PI),
          "virtual_hfov must lie between 0 and pi rad");
  for (const double side : square_sides)
    require(std::isfinite(side) && side > 0.0, "every side of the square must be above 0 m");
  require(!square_pose || (square_pose->origin.allFinite() && std::isfinite(square_pose->yaw)),
          "the square's origin and yaw must be numbers");

  std::vector<std::string> names;
  for (const RigCamera& camera : cameras) {
    const std::string& name = names.emplace_back(camera.camera.name);
    // A namespace, so slashes are allowed.
    require(isWord(withoutSlashes(name)),
            "'" + name +
                "' is no name for a camera; use a letter, then letters, digits and underscores");
    try {
      checkCamera(camera);
    } catch (const InvalidRigError& e) {
      throw InvalidRigError("camera '" + name + "': " + e.what());
    }
  }
  const std::string clash = nameClash(names);
  require(clash.empty(), clash);

  const Eigen::Index parameters = firstParameter(cameras.size());
  require(covariance.size() == 0 ||
              (covariance.rows() == parameters && covariance.cols() == parameters),
          "the rig's covariance must have 16 rows and columns per camera, or none");
  require(covariance.size() == 0 || covariance.allFinite(), "the rig's covariance is not finite");
  for (std::size_t i = 0; covariance.size() > 0 && i < cameras.size(); ++i) {
    const Camera& camera = cameras[i].camera;
    const DistortionModel model = camera.intrinsics.distortion_model;
    const auto count = static_cast<Eigen::Index>(coefficientCount(model));
    for (Eigen::Index k = firstParameter(i) + kDistortion + count;
         k < firstParameter(i) + kTimeOffset; ++k)
      require(covariance.row(k).isZero(0.0) && covariance.col(k).isZero(0.0),
              "camera '" + camera.name + "': the rig's covariance must be zero after the " +
                  std::to_string(count) + " coefficients of " + nameOf(model));
  }
  if (remap)
    remap->check();
  std::set<std::string> zone_names;
  for (const Zone& zone : zones) {
    require(isFreeName(zone.name), "the name of zone " + std::to_string(zone_names.size() + 1) +
                                       " must have " + kFreeName + ": correct it");
    require(zone_names.insert(zone.name).second,
            "zone '" + zone.name + "' is there twice: give each a name of its own");
    require(zone.minimum.allFinite() && zone.maximum.allFinite() &&
                (zone.minimum.array() <= zone.maximum.array()).all(),
            "zone '" + zone.name + "': minimum must not be above maximum");
  }
}

bool isSameCamera(const RigCamera& a, const RigCamera& b) {
  constexpr double kNoticeable = 0.001;  // more is no better calibration, but another clock [s]
  using Rule = TimeOffsetRule;
  return a.camera.name == b.camera.name && a.camera.identity == b.camera.identity &&
         a.time_offset_rule == b.time_offset_rule &&
         (a.time_offset_rule != Rule::kOneEpoch || a.time_offset_epoch == b.time_offset_epoch) &&
         (a.time_offset_rule == Rule::kNone ||
          std::abs(a.time_offset - b.time_offset) <= kNoticeable) &&
         haveSamePose(a.camera, b.camera);
}

bool haveSameCameras(const Rig& a, const Rig& b) {
  return std::equal(
      a.cameras.begin(), a.cameras.end(), b.cameras.begin(), b.cameras.end(),
      [](const auto& one, const auto& other) { return one.camera.name == other.camera.name; });
}

std::string withoutSlashes(const std::string& camera_name) {
  std::string name = camera_name.substr(camera_name.compare(0, 1, "/") == 0 ? 1 : 0);
  std::replace(name.begin(), name.end(), '/', '_');
  return name;
}

std::string opticalFrame(const std::string& camera_name) {
  return withoutSlashes(camera_name) + "_optical_frame";
}

std::string nameClash(const std::vector<std::string>& camera_names) {
  std::map<std::string, std::string> by_frame;
  for (const std::string& name : camera_names) {
    const auto [other, is_new] = by_frame.emplace(opticalFrame(name), name);
    if (is_new)
      continue;
    if (other->second == name)
      return "two cameras share the name '" + name + "'; rename one";
    return "two cameras, '" + other->second + "' and '" + name + "', share the frame " +
           opticalFrame(name) + " and the file " + withoutSlashes(name) + ".yaml; rename one";
  }
  return "";
}

}  // namespace wiimote_tracker::geometry
