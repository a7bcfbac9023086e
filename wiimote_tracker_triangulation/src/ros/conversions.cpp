#include "wiimote_tracker_triangulation/ros/conversions.h"

#include "geometry/rotation.h"
#include "wiimote_tracker_triangulation/geometry/camera_parameters.h"
#include "wiimote_tracker_triangulation/geometry/error.h"
#include "wiimote_tracker_triangulation/ros/message_fields.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

namespace wiimote_tracker {
namespace {

using wiimote_tracker_msgs::CameraCalibration;
using wiimote_tracker_msgs::RigCalibration;

static_assert(static_cast<int>(geometry::RayModel::kCalibrated) ==
                      RigCalibration::RAY_MODEL_CALIBRATED &&
                  static_cast<int>(geometry::RayModel::kImageCenter) ==
                      RigCalibration::RAY_MODEL_IMAGE_CENTER &&
                  static_cast<int>(geometry::TimeOffsetRule::kNone) ==
                      CameraCalibration::TIME_OFFSET_NONE &&
                  static_cast<int>(geometry::TimeOffsetRule::kAlways) ==
                      CameraCalibration::TIME_OFFSET_ALWAYS &&
                  static_cast<int>(geometry::TimeOffsetRule::kOneEpoch) ==
                      CameraCalibration::TIME_OFFSET_ONE_EPOCH,
              "enumerations of core and messages must agree");

Eigen::Isometry3d poseOf(const geometry_msgs::Pose& pose, const std::string& camera) {
  const Eigen::Quaterniond q = rotationOf(pose.orientation);
  if (!(std::abs(q.norm() - 1.0) < 1e-3))
    throw geometry::InvalidRigError("camera '" + camera +
                                    "': its orientation is not a quaternion of unit length; "
                                    "publish the rig again");
  Eigen::Isometry3d isometry = Eigen::Isometry3d::Identity();
  isometry.linear() = geometry::matrixFromQuaternion(q);
  isometry.translation() = vectorOf(pose.position);
  return isometry;
}

CameraCalibration cameraToMessage(const geometry::RigCamera& rig_camera) {
  const geometry::Camera& camera = rig_camera.camera;
  const geometry::Intrinsics& intrinsics = camera.intrinsics;
  CameraCalibration message;
  message.name = camera.name;
  message.identity = camera.identity;
  message.frame_id = opticalFrame(camera.name);
  message.width = static_cast<std::uint32_t>(intrinsics.width);
  message.height = static_cast<std::uint32_t>(intrinsics.height);
  message.distortion_model = nameOf(intrinsics.distortion_model);
  message.fx = intrinsics.fx;
  message.fy = intrinsics.fy;
  message.cx = intrinsics.cx;
  message.cy = intrinsics.cy;
  message.distortion.assign(
      intrinsics.distortion.begin(),
      intrinsics.distortion.begin() + coefficientCount(intrinsics.distortion_model));
  setVector(camera.center(), &message.world_from_camera.position);
  setRotation(geometry::canonicalQuaternion(camera.world_from_camera.linear()),
              &message.world_from_camera.orientation);
  message.time_offset = rig_camera.time_offset;
  message.time_offset_rule = static_cast<std::uint8_t>(rig_camera.time_offset_rule);
  message.time_offset_epoch = rig_camera.time_offset_epoch;
  if (rig_camera.gravity) {
    const Eigen::Vector3d& g = *rig_camera.gravity;
    message.gravity = {g.x(), g.y(), g.z()};
  }
  for (const geometry::ImageMask& mask : rig_camera.masks) {
    wiimote_tracker_msgs::IrMask m;
    m.x = mask.center.x();
    m.y = mask.center.y();
    m.radius = mask.radius;
    message.masks.push_back(m);
  }
  message.residual_px = rig_camera.residual_px;
  message.residual_m = rig_camera.residual_m;
  message.observations = rig_camera.observations;
  message.inliers = rig_camera.inliers;
  return message;
}

geometry::RigCamera cameraFromMessage(const CameraCalibration& message) {
  const std::string who = "camera '" + message.name + "': ";
  const auto model = geometry::distortionModelFromName(message.distortion_model);
  if (!model || message.distortion.size() != geometry::coefficientCount(*model))
    throw geometry::InvalidRigError(who + "distortion model '" + message.distortion_model +
                                    "' with " + std::to_string(message.distortion.size()) +
                                    " coefficients; use " + geometry::describeDistortionModels());
  if (message.time_offset_rule > CameraCalibration::TIME_OFFSET_ONE_EPOCH)
    throw geometry::InvalidRigError(who + "unknown time_offset_rule; publish the rig again");
  if (!message.gravity.empty() && message.gravity.size() != 3)
    throw geometry::InvalidRigError(who + "gravity needs three values or none");

  geometry::RigCamera rig_camera;
  geometry::Camera& camera = rig_camera.camera;
  camera.name = message.name;
  camera.identity = message.identity;
  camera.intrinsics.width = static_cast<int>(message.width);
  camera.intrinsics.height = static_cast<int>(message.height);
  camera.intrinsics.fx = message.fx;
  camera.intrinsics.fy = message.fy;
  camera.intrinsics.cx = message.cx;
  camera.intrinsics.cy = message.cy;
  camera.intrinsics.distortion_model = *model;
  std::copy(message.distortion.begin(), message.distortion.end(),
            camera.intrinsics.distortion.begin());
  camera.world_from_camera = poseOf(message.world_from_camera, message.name);
  rig_camera.time_offset = message.time_offset;
  rig_camera.time_offset_rule = static_cast<geometry::TimeOffsetRule>(message.time_offset_rule);
  rig_camera.time_offset_epoch = message.time_offset_epoch;
  if (!message.gravity.empty())
    rig_camera.gravity = Eigen::Vector3d(message.gravity.data());
  for (const wiimote_tracker_msgs::IrMask& mask : message.masks)
    rig_camera.masks.push_back({{mask.x, mask.y}, mask.radius});
  rig_camera.residual_px = message.residual_px;
  rig_camera.residual_m = message.residual_m;
  rig_camera.observations = message.observations;
  rig_camera.inliers = message.inliers;
  return rig_camera;
}

/// Index of each parameter of the message's covariance in that of the rig, which has five
/// distortion coefficients for every lens.
std::vector<Eigen::Index> parametersOfMessage(const geometry::Rig& rig) {
  std::vector<Eigen::Index> places;
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    const auto coefficients = static_cast<Eigen::Index>(
        geometry::coefficientCount(rig.cameras[i].camera.intrinsics.distortion_model));
    for (Eigen::Index p = 0; p < geometry::kParameters; ++p) {
      if (p < geometry::kDistortion + coefficients || p == geometry::kTimeOffset)
        places.push_back(geometry::firstParameter(i) + p);
    }
  }
  return places;
}

std::vector<double> covarianceToMessage(const geometry::Rig& rig) {
  const std::vector<Eigen::Index> places = parametersOfMessage(rig);
  std::vector<double> covariance;
  covariance.reserve(places.size() * places.size());
  for (const Eigen::Index row : places) {
    for (const Eigen::Index column : places)
      covariance.push_back(rig.covariance(row, column));
  }
  return covariance;
}

/// `rig`: with its cameras.
Eigen::MatrixXd covarianceFromMessage(const std::vector<double>& message,
                                      const geometry::Rig& rig) {
  const std::vector<Eigen::Index> places = parametersOfMessage(rig);
  if (message.size() != places.size() * places.size())
    throw geometry::InvalidRigError("the rig's covariance has " + std::to_string(message.size()) +
                                    " numbers, but its " + std::to_string(rig.cameras.size()) +
                                    " cameras have " + std::to_string(places.size()) +
                                    " parameters; publish the rig again");
  const Eigen::Index n = geometry::firstParameter(rig.cameras.size());
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(n, n);
  auto value = message.begin();
  for (const Eigen::Index row : places) {
    for (const Eigen::Index column : places)
      covariance(row, column) = *value++;
  }
  return covariance;
}

wiimote_tracker_msgs::RigRemap remapToMessage(const remap::Remap& remap) {
  wiimote_tracker_msgs::RigRemap message;
  message.rig_id = remap.rig_id;
  message.model = nameOf(remap.model);
  message.parameters = remap.parameters;
  for (const Eigen::Vector3d& point : remap.support)
    message.support.push_back(pointOf(point));
  return message;
}

remap::Remap remapFromMessage(const wiimote_tracker_msgs::RigRemap& message) {
  remap::Remap remap;
  remap.rig_id = message.rig_id;
  remap.model = remap::modelFromName(message.model);
  remap.parameters = message.parameters;
  for (const geometry_msgs::Point& point : message.support)
    remap.support.push_back(vectorOf(point));
  return remap;
}

}  // namespace

RigCalibration toMessage(const geometry::Rig& rig) {
  rig.check();
  RigCalibration message;
  message.header.frame_id = rig.world_frame;
  message.header.stamp.fromSec(rig.solved_at);
  message.format_version = RigCalibration::FORMAT_VERSION;
  message.id = rig.id();
  message.method = rig.method;
  message.ray_model = static_cast<std::uint8_t>(rig.ray_model);
  message.virtual_hfov = rig.virtual_hfov;
  message.square_sides = rig.square_sides;
  message.led_height = rig.led_height;
  for (const geometry::RigCamera& camera : rig.cameras)
    message.cameras.push_back(cameraToMessage(camera));
  if (geometry::hasCovariance(rig))
    message.covariance = covarianceToMessage(rig);
  if (rig.remap)
    message.remap = remapToMessage(*rig.remap);
  for (const geometry::Zone& zone : rig.zones) {
    wiimote_tracker_msgs::Zone z;
    z.name = zone.name;
    setVector(zone.minimum, &z.minimum);
    setVector(zone.maximum, &z.maximum);
    message.zones.push_back(z);
  }
  message.verdict = rig.verdict;
  return message;
}

geometry::Rig fromMessage(const RigCalibration& message) {
  if (message.format_version != RigCalibration::FORMAT_VERSION)
    throw geometry::InvalidRigError("the rig calibration has format version " +
                                    std::to_string(message.format_version) + ", but only " +
                                    std::to_string(RigCalibration::FORMAT_VERSION) +
                                    " is understood; use the program that made it");
  if (message.ray_model > RigCalibration::RAY_MODEL_IMAGE_CENTER)
    throw geometry::InvalidRigError(
        "the rig calibration has an unknown ray model; calibrate again");

  geometry::Rig rig;
  rig.world_frame = message.header.frame_id;
  rig.solved_at = message.header.stamp.toSec();
  rig.method = message.method;
  rig.ray_model = static_cast<geometry::RayModel>(message.ray_model);
  rig.virtual_hfov = message.virtual_hfov;
  rig.square_sides = message.square_sides;
  rig.led_height = message.led_height;
  for (const CameraCalibration& camera : message.cameras)
    rig.cameras.push_back(cameraFromMessage(camera));
  if (!message.covariance.empty())
    rig.covariance = covarianceFromMessage(message.covariance, rig);
  if (!message.remap.rig_id.empty())
    rig.remap = remapFromMessage(message.remap);
  for (const wiimote_tracker_msgs::Zone& zone : message.zones)
    rig.zones.push_back({zone.name, vectorOf(zone.minimum), vectorOf(zone.maximum)});
  rig.verdict = message.verdict;
  rig.check();
  return rig;
}

std::string idOf(const RigCalibration& message, const geometry::Rig& rig) {
  return message.id.empty() ? rig.id() : message.id;
}

sensor_msgs::CameraInfo cameraInfo(const geometry::Camera& camera) {
  const geometry::Intrinsics& lens = camera.intrinsics;
  sensor_msgs::CameraInfo info;
  info.header.frame_id = opticalFrame(camera.name);
  info.width = static_cast<std::uint32_t>(lens.width);
  info.height = static_cast<std::uint32_t>(lens.height);
  info.distortion_model = geometry::nameOf(lens.distortion_model);
  info.D.assign(lens.distortion.begin(),
                lens.distortion.begin() + geometry::coefficientCount(lens.distortion_model));
  info.K = {lens.fx, 0.0, lens.cx, 0.0, lens.fy, lens.cy, 0.0, 0.0, 1.0};
  info.R = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
  info.P = {lens.fx, 0.0, lens.cx, 0.0, 0.0, lens.fy, lens.cy, 0.0, 0.0, 0.0, 1.0, 0.0};
  return info;
}

std::vector<geometry_msgs::TransformStamped> staticTransforms(const geometry::Rig& rig) {
  std::vector<geometry_msgs::TransformStamped> transforms;
  for (const geometry::RigCamera& rig_camera : rig.cameras) {
    const geometry::Camera& camera = rig_camera.camera;
    geometry_msgs::TransformStamped transform;
    transform.header.frame_id = rig.world_frame;
    transform.header.stamp.fromSec(rig.solved_at);
    transform.child_frame_id = opticalFrame(camera.name);
    setVector(camera.center(), &transform.transform.translation);
    setRotation(geometry::canonicalQuaternion(camera.world_from_camera.linear()),
                &transform.transform.rotation);
    transforms.push_back(transform);
  }
  return transforms;
}

}  // namespace wiimote_tracker
