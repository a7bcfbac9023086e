#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_GEOMETRY_CAMERA_YAML_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_GEOMETRY_CAMERA_YAML_H

#include "wiimote_tracker_triangulation/geometry/camera.h"
#include "wiimote_tracker_triangulation/geometry/yaml_map.h"

#include <yaml-cpp/emitter.h>

#include <string>

namespace wiimote_tracker::geometry {

/// Plain YAML text of a number that reads back bit for bit, as a floating-point number also where
/// YAML 1.1 is read.
std::string yamlNumber(double value);

/// Writes the intrinsics into an open map, in the keys of camera_calibration_parsers:
/// image_width .. distortion_coefficients.
void emitIntrinsics(const std::string& camera_name,
                    const Intrinsics& intrinsics,
                    YAML::Emitter& out);

/// Reads what emitIntrinsics wrote. @throws FileError naming the key.
void readIntrinsics(YamlMap& map, std::string* camera_name, Intrinsics* intrinsics);

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

/// @throws FileError naming the key when the sizes disagree.
Eigen::MatrixXd readMatrix(YamlMap map);

}  // namespace wiimote_tracker::geometry

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_GEOMETRY_CAMERA_YAML_H
