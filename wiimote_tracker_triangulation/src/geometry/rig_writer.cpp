#include "geometry/rotation.h"
#include "rig_words.h"
#include "wiimote_tracker_triangulation/geometry/atomic_file.h"
#include "wiimote_tracker_triangulation/geometry/error.h"
#include "wiimote_tracker_triangulation/geometry/rig_file.h"
#include "wiimote_tracker_triangulation/geometry/yaml_map.h"

#include <wiimote_tracker_msgs/text.h>
#include <yaml-cpp/emitter.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace wiimote_tracker::geometry {
namespace {

/// Plain text of a number that reads back bit for bit, as a floating-point number also where
/// YAML 1.1 is read.
std::string yamlNumber(double value) {
  if (std::isnan(value))
    return ".nan";
  if (std::isinf(value))
    return value > 0.0 ? ".inf" : "-.inf";
  std::string number = exactNumber(value);
  // YAML 1.1, as in rosparam, reads 4 as an integer and 1e-09 as a string.
  if (number.find('.') == std::string::npos)
    number.insert(std::min(number.find('e'), number.size()), ".0");
  return number;
}

/// @param values a std::vector or Eigen's
template <typename Values>
std::vector<std::string> yamlNumbers(const Values& values) {
  std::vector<std::string> numbers;
  std::transform(values.data(), values.data() + values.size(), std::back_inserter(numbers),
                 yamlNumber);
  return numbers;
}

/// {rows, cols, data} of a matrix, row-major.
void emitMatrix(const std::string& key, const Eigen::MatrixXd& matrix, YAML::Emitter& out) {
  out << key << YAML::BeginMap << "rows" << matrix.rows() << "cols" << matrix.cols();
  const Eigen::MatrixXd by_rows = matrix.transpose();
  out << "data" << YAML::Flow << yamlNumbers(by_rows) << YAML::EndMap;
}

Eigen::Matrix3d matrixOf(const Intrinsics& lens) {
  Eigen::Matrix3d K;
  K << lens.fx, 0.0, lens.cx, 0.0, lens.fy, lens.cy, 0.0, 0.0, 1.0;
  return K;
}

/// Into an open map, in the keys of camera_calibration_parsers: image_width ..
/// distortion_coefficients.
void emitIntrinsics(const std::string& camera_name,
                    const Intrinsics& intrinsics,
                    YAML::Emitter& out) {
  const Eigen::Map<const Eigen::RowVectorXd> D(
      intrinsics.distortion.data(),
      static_cast<Eigen::Index>(coefficientCount(intrinsics.distortion_model)));
  out << "image_width" << intrinsics.width;
  out << "image_height" << intrinsics.height;
  out << "camera_name" << camera_name;
  emitMatrix("camera_matrix", matrixOf(intrinsics), out);
  out << "distortion_model" << nameOf(intrinsics.distortion_model);
  emitMatrix("distortion_coefficients", D, out);
}

/// The layout of a geometry_msgs/TransformStamped.
void emitExtrinsics(const Camera& camera, const std::string& world_frame, YAML::Emitter& out) {
  const Eigen::Vector3d t = camera.center();
  const Eigen::Quaterniond q = canonicalQuaternion(camera.world_from_camera.linear());
  out << "extrinsics" << YAML::BeginMap << "header" << YAML::BeginMap;
  out << "frame_id" << YAML::DoubleQuoted << world_frame;
  out << YAML::EndMap;
  out << "child_frame_id" << YAML::DoubleQuoted << opticalFrame(camera.name);
  out << "transform" << YAML::BeginMap << "translation" << YAML::BeginMap;
  out << "x" << yamlNumber(t.x()) << "y" << yamlNumber(t.y()) << "z" << yamlNumber(t.z());
  out << YAML::EndMap << "rotation" << YAML::BeginMap;
  out << "x" << yamlNumber(q.x()) << "y" << yamlNumber(q.y()) << "z" << yamlNumber(q.z());
  out << "w" << yamlNumber(q.w());
  out << YAML::EndMap << YAML::EndMap << YAML::EndMap;
}

void emitMasks(const std::vector<ImageMask>& masks, YAML::Emitter& out) {
  out << "masks" << YAML::BeginSeq;
  for (const ImageMask& mask : masks) {
    out << YAML::Flow << YAML::BeginMap;
    out << "x" << yamlNumber(mask.center.x()) << "y" << yamlNumber(mask.center.y());
    out << "radius" << yamlNumber(mask.radius) << YAML::EndMap;
  }
  out << YAML::EndSeq;
}

void emitCamera(const RigCamera& camera, const std::string& world_frame, YAML::Emitter& out) {
  out << YAML::BeginMap;
  out << "identity" << YAML::DoubleQuoted << camera.camera.identity;
  emitIntrinsics(camera.camera.name, camera.camera.intrinsics, out);
  emitExtrinsics(camera.camera, world_frame, out);
  out << "time_offset" << yamlNumber(camera.time_offset);
  out << "time_offset_rule"
      << kTimeOffsetRuleWords[static_cast<std::size_t>(camera.time_offset_rule)];
  out << "time_offset_epoch" << camera.time_offset_epoch;
  out << "gravity" << YAML::Flow;
  out << (camera.gravity ? yamlNumbers(*camera.gravity) : std::vector<std::string>());
  emitMasks(camera.masks, out);
  out << "residual_px" << yamlNumber(camera.residual_px);
  out << "residual_m" << yamlNumber(camera.residual_m);
  out << "observations" << camera.observations;
  out << "inliers" << camera.inliers;
  out << YAML::EndMap;
}

void emitRemap(const remap::Remap& remap, YAML::Emitter& out) {
  out << "remap" << YAML::BeginMap;
  out << "rig_id" << YAML::DoubleQuoted << remap.rig_id;
  out << "model" << nameOf(remap.model);
  out << "parameters" << YAML::Flow << yamlNumbers(remap.parameters);
  out << "support" << YAML::BeginSeq;
  for (const Eigen::Vector3d& point : remap.support)
    out << YAML::Flow << yamlNumbers(point);
  out << YAML::EndSeq << YAML::EndMap;
}

/// @throws FileError: readRigFile would refuse the file.
void checkReadable(const std::string& text, const Rig& rig, const std::string& path) {
  if (text.size() > kLargestReadable)
    throw FileError(format(
        "cannot write %s: a rig of %zu cameras that takes %.0f MB could not be read, as no file "
        "above %.0f MB; calibrate fewer cameras together",
        path.c_str(), rig.cameras.size(), 1e-6 * text.size(), 1e-6 * kLargestReadable));
  if (text.find(kUnreadableText) != std::string::npos)
    throw FileError("cannot write " + path + ": a name in it has '" + kUnreadableText +
                    "' and could not be read; rename that zone, frame or camera");
}

}  // namespace

void writeRigFile(const Rig& rig, const std::string& path) {
  rig.check();
  YAML::Emitter out;
  out << YAML::BeginMap;
  out << "format" << kRigFormat;
  out << "version" << kRigFormatVersion;
  out << "world_frame" << YAML::DoubleQuoted << rig.world_frame;
  out << "solved_at" << yamlNumber(rig.solved_at);
  out << YAML::Comment(utcDate(rig.solved_at));
  out << "method" << YAML::DoubleQuoted << rig.method;
  out << "verdict" << YAML::DoubleQuoted << rig.verdict;
  out << "ray_model" << kRayModelWords[static_cast<std::size_t>(rig.ray_model)];
  out << "virtual_hfov" << yamlNumber(rig.virtual_hfov);
  out << "square_sides" << YAML::Flow << yamlNumbers(rig.square_sides);
  if (rig.square_pose) {
    out << "square_origin" << YAML::Flow << yamlNumbers(rig.square_pose->origin);
    out << "square_yaw" << yamlNumber(rig.square_pose->yaw);
  }
  out << "led_height" << yamlNumber(rig.led_height);

  out << "camera_order" << YAML::Flow << YAML::BeginSeq;
  for (const RigCamera& camera : rig.cameras)
    out << camera.camera.name;
  out << YAML::EndSeq;
  out << "cameras" << YAML::BeginMap;
  for (const RigCamera& camera : rig.cameras) {
    out << camera.camera.name;
    emitCamera(camera, rig.world_frame, out);
  }
  out << YAML::EndMap;

  // Without zones, the file shows how one is written.
  out << "zones" << (rig.zones.empty() ? YAML::Flow : YAML::Block) << YAML::BeginSeq;
  for (const Zone& zone : rig.zones) {
    out << YAML::BeginMap;
    out << "name" << YAML::DoubleQuoted << zone.name;
    out << "minimum" << YAML::Flow << yamlNumbers(zone.minimum);
    out << "maximum" << YAML::Flow << yamlNumbers(zone.maximum);
    out << YAML::EndMap;
  }
  out << YAML::EndSeq;
  if (rig.zones.empty())
    out << YAML::Comment("[m] such as [{name: hall, minimum: [0, 0, 0], maximum: [2, 3, 2.5]}]");
  emitMatrix("covariance", rig.covariance, out);
  if (rig.remap)
    emitRemap(*rig.remap, out);
  // The last key: without it, the file was cut off.
  out << "complete" << true;
  out << YAML::EndMap;
  const std::string text = std::string(out.c_str()) + "\n";
  checkReadable(text, rig, path);
  writeFileAtomically(path, text);
}

void writeCameraInfoFile(const Camera& camera, const std::string& path) {
  Eigen::Matrix<double, 3, 4> P;
  P << matrixOf(camera.intrinsics), Eigen::Vector3d::Zero();
  YAML::Emitter out;
  out << YAML::BeginMap;
  // camera_calibration_parsers allows letters, digits and underscores.
  emitIntrinsics(withoutSlashes(camera.name), camera.intrinsics, out);
  emitMatrix("rectification_matrix", Eigen::Matrix3d::Identity(), out);
  emitMatrix("projection_matrix", P, out);
  out << YAML::EndMap;
  writeFileAtomically(path, std::string(out.c_str()) + "\n");
}

}  // namespace wiimote_tracker::geometry
