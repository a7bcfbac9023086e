#include "camera_yaml.h"
#include "wiimote_tracker_triangulation/geometry/atomic_file.h"
#include "wiimote_tracker_triangulation/geometry/rig_file.h"

namespace wiimote_tracker::geometry {

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
