#include "camera_yaml.h"

#include <wiimote_tracker_msgs/text.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace wiimote_tracker::geometry {

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
    throw map.error("distortion_model", "is neither plumb_bob nor equidistant");
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

Eigen::MatrixXd readMatrix(YamlMap map) {
  constexpr int kMaximumSize = 10000;
  const int rows = map.bounded("rows", 0, kMaximumSize);
  const int cols = map.bounded("cols", 0, kMaximumSize);
  const std::vector<double> data = map.numbers("data");
  map.refuseUnknown();
  if (data.size() != static_cast<std::size_t>(rows) * static_cast<std::size_t>(cols))
    throw map.error("data", "does not have rows * cols numbers");
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  return Eigen::Map<const RowMajor>(data.data(), rows, cols);
}

}  // namespace wiimote_tracker::geometry
