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

template <typename Values>
void emitNumbers(const std::string& key, const Values& values, YAML::Emitter& out) {
  out << YAML::Key << key << YAML::Value << YAML::Flow << YAML::BeginSeq;
  for (const double value : values)
    out << yamlNumber(value);
  out << YAML::EndSeq;
}

void emitVector(const std::string& key, const Eigen::Vector3d& v, YAML::Emitter& out) {
  emitNumbers(key, std::array<double, 3>{v.x(), v.y(), v.z()}, out);
}

void emitNumber(const std::string& key, double value, YAML::Emitter& out) {
  out << YAML::Key << key << YAML::Value << yamlNumber(value);
}

void emitText(const std::string& key, const std::string& text, YAML::Emitter& out) {
  out << YAML::Key << key << YAML::Value << YAML::DoubleQuoted << text;
}

/// {rows, cols, data} of a matrix, row-major.
template <typename Matrix>
void emitMatrix(const std::string& key, const Matrix& matrix, YAML::Emitter& out) {
  out << YAML::Key << key << YAML::Value << YAML::BeginMap;
  out << YAML::Key << "rows" << YAML::Value << matrix.rows();
  out << YAML::Key << "cols" << YAML::Value << matrix.cols();
  out << YAML::Key << "data" << YAML::Value << YAML::Flow << YAML::BeginSeq;
  for (Eigen::Index r = 0; r < matrix.rows(); ++r) {
    for (Eigen::Index c = 0; c < matrix.cols(); ++c)
      out << yamlNumber(matrix(r, c));
  }
  out << YAML::EndSeq << YAML::EndMap;
}

/// Into an open map, in the keys of camera_calibration_parsers: image_width ..
/// distortion_coefficients.
void emitIntrinsics(const std::string& camera_name,
                    const Intrinsics& intrinsics,
                    YAML::Emitter& out) {
  Eigen::Matrix3d K = Eigen::Matrix3d::Identity();
  K(0, 0) = intrinsics.fx;
  K(1, 1) = intrinsics.fy;
  K(0, 2) = intrinsics.cx;
  K(1, 2) = intrinsics.cy;
  const Eigen::Map<const Eigen::RowVectorXd> D(
      intrinsics.distortion.data(),
      static_cast<Eigen::Index>(coefficientCount(intrinsics.distortion_model)));
  out << YAML::Key << "image_width" << YAML::Value << intrinsics.width;
  out << YAML::Key << "image_height" << YAML::Value << intrinsics.height;
  out << YAML::Key << "camera_name" << YAML::Value << camera_name;
  emitMatrix("camera_matrix", K, out);
  out << YAML::Key << "distortion_model" << YAML::Value << nameOf(intrinsics.distortion_model);
  emitMatrix("distortion_coefficients", D, out);
}

/// The layout of a geometry_msgs/TransformStamped.
void emitExtrinsics(const Camera& camera, const std::string& world_frame, YAML::Emitter& out) {
  const Eigen::Vector3d t = camera.center();
  const Eigen::Quaterniond q = canonicalQuaternion(camera.world_from_camera.linear());
  out << YAML::Key << "extrinsics" << YAML::Value << YAML::BeginMap;
  out << YAML::Key << "header" << YAML::Value << YAML::BeginMap;
  emitText("frame_id", world_frame, out);
  out << YAML::EndMap;
  emitText("child_frame_id", opticalFrame(camera.name), out);
  out << YAML::Key << "transform" << YAML::Value << YAML::BeginMap;
  out << YAML::Key << "translation" << YAML::Value << YAML::BeginMap;
  emitNumber("x", t.x(), out);
  emitNumber("y", t.y(), out);
  emitNumber("z", t.z(), out);
  out << YAML::EndMap;
  out << YAML::Key << "rotation" << YAML::Value << YAML::BeginMap;
  emitNumber("x", q.x(), out);
  emitNumber("y", q.y(), out);
  emitNumber("z", q.z(), out);
  emitNumber("w", q.w(), out);
  out << YAML::EndMap << YAML::EndMap << YAML::EndMap;
}

void emitMasks(const std::vector<ImageMask>& masks, YAML::Emitter& out) {
  out << YAML::Key << "masks" << YAML::Value << YAML::BeginSeq;
  for (const ImageMask& mask : masks) {
    out << YAML::Flow << YAML::BeginMap;
    emitNumber("x", mask.center.x(), out);
    emitNumber("y", mask.center.y(), out);
    emitNumber("radius", mask.radius, out);
    out << YAML::EndMap;
  }
  out << YAML::EndSeq;
}

void emitCamera(const RigCamera& camera, const std::string& world_frame, YAML::Emitter& out) {
  out << YAML::BeginMap;
  emitText("identity", camera.camera.identity, out);
  emitIntrinsics(camera.camera.name, camera.camera.intrinsics, out);
  emitExtrinsics(camera.camera, world_frame, out);
  emitNumber("time_offset", camera.time_offset, out);
  out << YAML::Key << "time_offset_rule" << YAML::Value
      << kTimeOffsetRuleWords[static_cast<std::size_t>(camera.time_offset_rule)];
  out << YAML::Key << "time_offset_epoch" << YAML::Value << camera.time_offset_epoch;
  if (camera.gravity)
    emitVector("gravity", *camera.gravity, out);
  else
    emitNumbers("gravity", std::array<double, 0>{}, out);
  emitMasks(camera.masks, out);
  emitNumber("residual_px", camera.residual_px, out);
  emitNumber("residual_m", camera.residual_m, out);
  out << YAML::Key << "observations" << YAML::Value << camera.observations;
  out << YAML::Key << "inliers" << YAML::Value << camera.inliers;
  out << YAML::EndMap;
}

void emitRemap(const remap::Remap& remap, YAML::Emitter& out) {
  out << YAML::Key << "remap" << YAML::Value << YAML::BeginMap;
  emitText("rig_id", remap.rig_id, out);
  out << YAML::Key << "model" << YAML::Value << nameOf(remap.model);
  emitNumbers("parameters", remap.parameters, out);
  out << YAML::Key << "support" << YAML::Value << YAML::BeginSeq;
  for (const Eigen::Vector3d& point : remap.support)
    out << YAML::Flow << YAML::BeginSeq << yamlNumber(point.x()) << yamlNumber(point.y())
        << yamlNumber(point.z()) << YAML::EndSeq;
  out << YAML::EndSeq << YAML::EndMap;
}

/// @throws FileError: readRigFile would refuse the file.
void checkReadable(const std::string& text, const Rig& rig, const std::string& path) {
  if (text.size() > kLargestReadable)
    throw FileError(format(
        "cannot write %s: a rig of %zu cameras that takes %.0f MB could not be read, as no file "
        "above %.0f MB; calibrate fewer cameras together",
        path.c_str(), rig.cameras.size(), 1e-6 * static_cast<double>(text.size()),
        1e-6 * static_cast<double>(kLargestReadable)));
  if (text.find(kUnreadableText) != std::string::npos)
    throw FileError("cannot write " + path + ": a name in it has '" + kUnreadableText +
                    "' and could not be read; rename that zone, frame or camera");
}

}  // namespace

void writeRigFile(const Rig& rig, const std::string& path) {
  rig.check();
  YAML::Emitter out;
  out << YAML::BeginMap;
  out << YAML::Key << "format" << YAML::Value << kRigFormat;
  out << YAML::Key << "version" << YAML::Value << kRigFormatVersion;
  emitText("world_frame", rig.world_frame, out);
  emitNumber("solved_at", rig.solved_at, out);
  out << YAML::Comment(utcDate(rig.solved_at));
  emitText("method", rig.method, out);
  emitText("verdict", rig.verdict, out);
  out << YAML::Key << "ray_model" << YAML::Value
      << kRayModelWords[static_cast<std::size_t>(rig.ray_model)];
  emitNumber("virtual_hfov", rig.virtual_hfov, out);
  emitNumbers("square_sides", rig.square_sides, out);
  if (rig.square_pose) {
    const Eigen::Vector2d& origin = rig.square_pose->origin;
    emitNumbers("square_origin", std::array<double, 2>{origin.x(), origin.y()}, out);
    emitNumber("square_yaw", rig.square_pose->yaw, out);
  }
  emitNumber("led_height", rig.led_height, out);

  out << YAML::Key << "camera_order" << YAML::Value << YAML::Flow << YAML::BeginSeq;
  for (const RigCamera& camera : rig.cameras)
    out << camera.camera.name;
  out << YAML::EndSeq;
  out << YAML::Key << "cameras" << YAML::Value << YAML::BeginMap;
  for (const RigCamera& camera : rig.cameras) {
    out << YAML::Key << camera.camera.name << YAML::Value;
    emitCamera(camera, rig.world_frame, out);
  }
  out << YAML::EndMap;

  // Without zones, the file shows how one is written.
  out << YAML::Key << "zones" << YAML::Value;
  if (rig.zones.empty())
    out << YAML::Flow;
  out << YAML::BeginSeq;
  for (const Zone& zone : rig.zones) {
    out << YAML::BeginMap;
    emitText("name", zone.name, out);
    emitVector("minimum", zone.minimum, out);
    emitVector("maximum", zone.maximum, out);
    out << YAML::EndMap;
  }
  out << YAML::EndSeq;
  if (rig.zones.empty())
    out << YAML::Comment("[m] such as [{name: hall, minimum: [0, 0, 0], maximum: [2, 3, 2.5]}]");
  emitMatrix("covariance", rig.covariance, out);
  if (rig.remap)
    emitRemap(*rig.remap, out);
  // The last key: without it, the file was cut off.
  out << YAML::Key << "complete" << YAML::Value << true;
  out << YAML::EndMap;
  const std::string text = std::string(out.c_str()) + "\n";
  checkReadable(text, rig, path);
  writeFileAtomically(path, text);
}

void writeCameraInfoFile(const Camera& camera, const std::string& path) {
  const Intrinsics& intrinsics = camera.intrinsics;
  Eigen::Matrix<double, 3, 4> P = Eigen::Matrix<double, 3, 4>::Zero();
  P(0, 0) = intrinsics.fx;
  P(1, 1) = intrinsics.fy;
  P(0, 2) = intrinsics.cx;
  P(1, 2) = intrinsics.cy;
  P(2, 2) = 1.0;

  YAML::Emitter out;
  out << YAML::BeginMap;
  // camera_calibration_parsers allows letters, digits and underscores.
  emitIntrinsics(withoutSlashes(camera.name), intrinsics, out);
  emitMatrix("rectification_matrix", Eigen::Matrix3d::Identity(), out);
  emitMatrix("projection_matrix", P, out);
  out << YAML::EndMap;
  writeFileAtomically(path, std::string(out.c_str()) + "\n");
}

}  // namespace wiimote_tracker::geometry
