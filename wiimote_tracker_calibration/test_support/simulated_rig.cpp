#include "simulated_rig.h"

#include <wiimote_tracker_triangulation/geometry/camera_parameters.h>
#include <wiimote_tracker_triangulation/geometry/so3.h>

#include <Eigen/Cholesky>

#include <cmath>
#include <string>

namespace wiimote_tracker {

geometry::Rig paperRigWith(const RigErrors& errors, std::size_t cameras) {
  geometry::Rig rig;
  const std::vector<Eigen::Isometry3d> poses = square::paperRig(cameras);
  for (std::size_t i = 0; i < cameras; ++i) {
    geometry::RigCamera camera;
    camera.camera.name = "camera_" + std::to_string(i + 1);
    camera.camera.identity = "00:1e:35:00:00:0" + std::to_string(i + 1);
    camera.camera.world_from_camera = poses[i];
    camera.time_offset = 0.001 * static_cast<double>(i);
    camera.time_offset_rule = geometry::TimeOffsetRule::kOneEpoch;
    camera.time_offset_epoch = 7;
    camera.gravity = 9.81 * poses[i].linear().row(2).transpose();
    rig.cameras.push_back(camera);
  }
  const Eigen::Index size = geometry::kParameters;
  Eigen::VectorXd stddev = Eigen::VectorXd::Zero(size);
  stddev.segment<3>(geometry::kRotation).setConstant(errors.rotation);
  stddev.segment<3>(geometry::kPosition).setConstant(errors.position);
  stddev.segment<2>(geometry::kIntrinsics).setConstant(errors.focal);
  stddev.segment<2>(geometry::kIntrinsics + 2).setConstant(errors.principal_point);
  stddev[geometry::kDistortion] = errors.k1;
  stddev[geometry::kDistortion + 1] = errors.k2;
  stddev[geometry::kTimeOffset] = errors.time_offset;
  const auto n = static_cast<Eigen::Index>(cameras);
  rig.covariance.resize(n * size, n * size);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j)
      rig.covariance.block(i * size, j * size, size, size) =
          (i == j ? 2.0 : 1.0) * Eigen::MatrixXd(stddev.cwiseAbs2().asDiagonal());
  }
  return rig;
}

geometry::RigCamera displaced(geometry::RigCamera camera, const Eigen::VectorXd& delta) {
  geometry::Camera& c = camera.camera;
  const Eigen::Vector3d w = delta.segment<3>(geometry::kRotation);
  c.world_from_camera.linear() = geometry::so3::exp(w) * c.world_from_camera.linear();
  c.world_from_camera.translation() += delta.segment<3>(geometry::kPosition);
  c.intrinsics.fx += delta[geometry::kIntrinsics];
  c.intrinsics.fy += delta[geometry::kIntrinsics + 1];
  c.intrinsics.cx += delta[geometry::kIntrinsics + 2];
  c.intrinsics.cy += delta[geometry::kIntrinsics + 3];
  for (Eigen::Index k = geometry::kDistortion; k < geometry::kTimeOffset; ++k)
    c.intrinsics.distortion[static_cast<std::size_t>(k - geometry::kDistortion)] += delta[k];
  camera.time_offset += delta[geometry::kTimeOffset];
  return camera;
}

geometry::RigCamera turned(geometry::RigCamera camera, double angle, square::Random& random) {
  camera.camera.world_from_camera.rotate(Eigen::AngleAxisd(angle, square::anyDirection(random)));
  return camera;
}

geometry::RigCamera turned(geometry::RigCamera camera, const Eigen::Vector3d& rotation) {
  camera.camera.world_from_camera.rotate(geometry::so3::exp(rotation));
  return camera;
}

Eigen::Vector3d reading(const Eigen::Vector3d& force,
                        double noise,
                        double step,
                        square::Random& random) {
  Eigen::Vector3d value = force;
  for (Eigen::Index i = 0; i < 3; ++i)
    value[i] = step * std::round((value[i] + square::normal(random, noise)) / step);
  return value;
}

std::vector<geometry::RigCamera> drawTruth(const geometry::Rig& rig, square::Random& random) {
  Eigen::VectorXd white(rig.covariance.rows());
  for (Eigen::Index i = 0; i < white.size(); ++i)
    white[i] = square::normal(random, 1.0);
  // Parameters that were held have no variance: the factorisation must bear with zeros.
  const Eigen::LDLT<Eigen::MatrixXd> factor(rig.covariance);
  const Eigen::VectorXd scaled = factor.vectorD().cwiseMax(0.0).cwiseSqrt().cwiseProduct(white);
  const Eigen::VectorXd delta =
      factor.transpositionsP().transpose() * (factor.matrixL() * scaled).eval();
  std::vector<geometry::RigCamera> truth;
  for (std::size_t i = 0; i < rig.cameras.size(); ++i)
    truth.push_back(displaced(rig.cameras[i],
                              delta.segment<geometry::kParameters>(geometry::firstParameter(i))));
  return truth;
}

}  // namespace wiimote_tracker
