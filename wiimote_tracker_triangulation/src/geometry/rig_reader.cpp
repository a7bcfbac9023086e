#include "geometry/rotation.h"
#include "rig_words.h"
#include "wiimote_tracker_triangulation/geometry/error.h"
#include "wiimote_tracker_triangulation/geometry/rig_file.h"
#include "wiimote_tracker_triangulation/geometry/yaml_map.h"

#include <wiimote_tracker_msgs/text.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <string>
#include <system_error>

namespace wiimote_tracker::geometry {
namespace {

template <typename Enum, std::size_t N>
Enum readWord(YamlMap& map, const std::string& key, const std::array<const char*, N>& words) {
  const std::string word = map.get<std::string>(key);
  const auto found = std::find(words.begin(), words.end(), word);
  if (found == words.end())
    throw map.error(key, "is '" + word + "', but must be one of: " + joined(words));
  return static_cast<Enum>(found - words.begin());
}

/// {rows, cols, data} of a matrix, row-major.
Eigen::MatrixXd readMatrix(YamlMap map) {
  constexpr int kMaximumSize = 10000;
  const int rows = map.bounded("rows", 0, kMaximumSize);
  const int cols = map.bounded("cols", 0, kMaximumSize);
  const std::vector<double> data = map.numbers("data");
  if (data.size() != static_cast<std::size_t>(rows) * static_cast<std::size_t>(cols))
    throw map.error("data", "does not have rows * cols numbers");
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  return Eigen::Map<const RowMajor>(data.data(), rows, cols);
}

/// In the keys of camera_calibration_parsers: image_width .. distortion_coefficients.
void readIntrinsics(YamlMap& map, std::string* camera_name, Intrinsics* intrinsics) {
  constexpr int kMaximumSize = std::numeric_limits<int>::max();
  intrinsics->width = map.bounded("image_width", 0, kMaximumSize);
  intrinsics->height = map.bounded("image_height", 0, kMaximumSize);
  *camera_name = map.get<std::string>("camera_name");

  const Eigen::MatrixXd K = readMatrix(map.map("camera_matrix"));
  if (K.rows() != 3 || K.cols() != 3 || K(0, 1) != 0.0 || K(1, 0) != 0.0 || K(2, 0) != 0.0 ||
      K(2, 1) != 0.0 || K(2, 2) != 1.0)
    throw map.error("camera_matrix", "is not [fx, 0, cx, 0, fy, cy, 0, 0, 1]");
  intrinsics->fx = K(0, 0);
  intrinsics->fy = K(1, 1);
  intrinsics->cx = K(0, 2);
  intrinsics->cy = K(1, 2);

  const auto model = distortionModelFromName(map.get<std::string>("distortion_model"));
  if (!model)
    throw map.error("distortion_model", "must be " + describeDistortionModels());
  intrinsics->distortion_model = *model;
  const Eigen::MatrixXd D = readMatrix(map.map("distortion_coefficients"));
  const auto count = static_cast<Eigen::Index>(coefficientCount(*model));
  if (D.rows() != 1 || D.cols() != count)
    throw map.error("distortion_coefficients", "is not one row of " + std::to_string(count) +
                                                   " numbers, as " + nameOf(*model) + " needs");
  intrinsics->distortion = {};
  for (Eigen::Index i = 0; i < count; ++i)
    intrinsics->distortion[static_cast<std::size_t>(i)] = D(0, i);
}

Eigen::Isometry3d readTransform(YamlMap map) {
  YamlMap translation = map.map("translation");
  YamlMap rotation = map.map("rotation");
  const Eigen::Quaterniond q(rotation.get<double>("w"), rotation.get<double>("x"),
                             rotation.get<double>("y"), rotation.get<double>("z"));
  // Rounded by hand is accepted; a wrong digit is not.
  if (!(std::abs(q.norm() - 1.0) < 1e-3))
    throw map.error("rotation", "is not a quaternion of unit length");
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
  transform.linear() = matrixFromQuaternion(q);
  // Not with <<: when a getter throws before the last coefficient, its assertion ends the program.
  transform.translation() = Eigen::Vector3d(
      translation.get<double>("x"), translation.get<double>("y"), translation.get<double>("z"));
  return transform;
}

Eigen::Isometry3d readExtrinsics(YamlMap map, const std::string& camera, const std::string& world) {
  YamlMap header = map.map("header");
  if (header.get<std::string>("frame_id") != world)
    throw header.error("frame_id", "is not the world_frame '" + world + "'");
  if (map.get<std::string>("child_frame_id") != opticalFrame(camera))
    throw map.error("child_frame_id", "is not '" + opticalFrame(camera) + "'");
  const Eigen::Isometry3d transform = readTransform(map.map("transform"));
  return transform;
}

std::vector<ImageMask> readMasks(YamlMap& map) {
  std::vector<ImageMask> masks;
  for (YamlMap& mask : map.maps("masks"))
    masks.push_back({{mask.get<double>("x"), mask.get<double>("y")}, mask.get<double>("radius")});
  return masks;
}

RigCamera readCamera(YamlMap map, const std::string& name, const std::string& world_frame) {
  constexpr std::uint32_t kNone = 0;
  constexpr std::uint32_t kMany = std::numeric_limits<std::uint32_t>::max();
  RigCamera camera;
  camera.camera.identity = map.get<std::string>("identity");
  readIntrinsics(map, &camera.camera.name, &camera.camera.intrinsics);
  if (camera.camera.name != name)
    throw map.error("camera_name",
                    "is '" + camera.camera.name + "', but its key is '" + name + "'");
  camera.camera.world_from_camera = readExtrinsics(map.map("extrinsics"), name, world_frame);
  camera.time_offset = map.get<double>("time_offset");
  camera.time_offset_rule = readWord<TimeOffsetRule>(map, "time_offset_rule", kTimeOffsetRuleWords);
  camera.time_offset_epoch = map.bounded("time_offset_epoch", kNone, kMany);
  if (!map.numbers("gravity").empty())
    camera.gravity = map.vector("gravity");
  camera.masks = readMasks(map);
  camera.residual_px = map.get<double>("residual_px");
  camera.residual_m = map.get<double>("residual_m");
  camera.observations = map.bounded("observations", kNone, kMany);
  camera.inliers = map.bounded("inliers", kNone, kMany);
  return camera;
}

remap::Remap readRemap(YamlMap map) {
  remap::Remap remap;
  remap.rig_id = map.get<std::string>("rig_id");
  const std::string model = map.get<std::string>("model");
  try {
    remap.model = remap::modelFromName(model);
  } catch (const Error& e) {
    throw map.error("model", std::string("cannot be used: ") + e.what());
  }
  remap.parameters = map.numbers("parameters");
  for (const std::vector<double>& point : map.rows("support", 3, "x, y, z"))
    remap.support.emplace_back(point[0], point[1], point[2]);
  return remap;
}

}  // namespace

Rig readRigFile(const std::string& path) {
  const std::string backup = path + ".bak";
  std::error_code ignored;
  const std::string advice = "correct the file, restore it from " +
                             (std::filesystem::exists(backup, ignored) ? backup : "its backup") +
                             ", or calibrate again";
  YamlMap map = YamlMap::load(path, advice.c_str());
  map.checkFormat(kRigFormat, kRigFormatVersion);
  if (!map.has("complete"))
    throw map.error("complete", "is missing: the file ends too early");
  if (map.get<std::string>("complete") != "true")
    throw map.error("complete", "is not true: the file was cut off");
  Rig rig;
  rig.world_frame = map.get<std::string>("world_frame");
  rig.solved_at = map.get<double>("solved_at");
  rig.method = map.get<std::string>("method");
  rig.verdict = map.get<std::string>("verdict");
  rig.ray_model = readWord<RayModel>(map, "ray_model", kRayModelWords);
  rig.virtual_hfov = map.get<double>("virtual_hfov");
  rig.square_sides = map.numbers("square_sides");
  if (map.has("square_origin")) {
    const std::vector<double> origin = map.numbers("square_origin", 2);
    rig.square_pose = SquarePose{{origin[0], origin[1]}, map.get<double>("square_yaw")};
  }
  rig.led_height = map.get<double>("led_height");
  YamlMap cameras = map.map("cameras");
  for (const std::string& name : map.get<std::vector<std::string>>("camera_order"))
    rig.cameras.push_back(readCamera(cameras.map(name), name, rig.world_frame));
  for (YamlMap& zone : map.maps("zones"))
    rig.zones.push_back(
        {zone.get<std::string>("name"), zone.vector("minimum"), zone.vector("maximum")});
  rig.covariance = readMatrix(map.map("covariance"));
  if (map.has("remap"))
    rig.remap = readRemap(map.map("remap"));
  map.refuseUnknown();
  try {
    rig.check();
  } catch (const Error& e) {
    throw InvalidRigError(path + ": " + e.what());
  }
  return rig;
}

}  // namespace wiimote_tracker::geometry
