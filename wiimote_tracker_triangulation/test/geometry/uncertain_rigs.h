#pragma once

#include "geometry/gaussian.h"
#include "geometry/random_rigs.h"
#include "wiimote_tracker_triangulation/geometry/camera_parameters.h"
#include "wiimote_tracker_triangulation/geometry/rig.h"
#include "wiimote_tracker_triangulation/geometry/triangulate.h"

#include <cstddef>
#include <vector>

namespace wiimote_tracker::geometry::test {

/// A covariance of the parameters of so many cameras, correlated between them. Standard deviations
/// are about 1.2 mrad, 4 mm and 2.5 px times `size`; time offsets are exact.
inline Eigen::MatrixXd randomCovariance(Random& random, int cameras, double size = 1.0) {
  const Eigen::Index n = kParameters * cameras;
  Eigen::VectorXd scale(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::Index k = i % kParameters;
    scale[i] = size * (k < kPosition     ? 1e-3
                       : k < kIntrinsics ? 3e-3
                       : k < kDistortion ? 2.0
                       : k < kTimeOffset ? 1e-3
                                         : 0.0);
  }
  Eigen::MatrixXd root = 0.3 * Eigen::MatrixXd::Identity(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j)
      root(i, j) += 0.15 * random.gaussian();
  }
  root = (scale.asDiagonal() * root).eval();
  return root * root.transpose();
}

/// Errors of the parameters drawn from a covariance.
class ParameterErrors {
 public:
  explicit ParameterErrors(Eigen::MatrixXd covariance) {
    covariance.diagonal().array() += 1e-15;
    root_ = rootOf(covariance);
  }

  Eigen::VectorXd draw(Random& random) const {
    Eigen::VectorXd z(root_.rows());
    for (Eigen::Index i = 0; i < z.size(); ++i)
      z[i] = random.gaussian();
    return root_ * z;
  }

 private:
  Eigen::MatrixXd root_;
};

/// The rig with errors added to its parameters, as RigCalibration.msg defines them.
inline Rig shifted(const Rig& rig, const Eigen::VectorXd& by) {
  Rig result = rig;
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    const auto d = by.segment<kParameters>(firstParameter(i));
    Camera& camera = result.cameras[i].camera;
    const Eigen::Vector3d w = d.head<3>();
    if (w.norm() > 0.0)
      camera.world_from_camera.linear() =
          Eigen::AngleAxisd(w.norm(), w.normalized()) * camera.world_from_camera.linear();
    camera.world_from_camera.translation() += d.segment<3>(kPosition);
    camera.intrinsics.fx += d[6];
    camera.intrinsics.fy += d[7];
    camera.intrinsics.cx += d[8];
    camera.intrinsics.cy += d[9];
    for (Eigen::Index k = 0; k < 5; ++k)
      camera.intrinsics.distortion[static_cast<std::size_t>(k)] += d[kDistortion + k];
  }
  return result;
}

/// The point that these cameras of the rig triangulate from the pixels of the true ones.
inline Eigen::Vector3d measured(const Rig& rig,
                                const Rig& truth,
                                const std::vector<std::size_t>& cameras,
                                const Eigen::Vector3d& point) {
  std::vector<Observation> observations;
  for (const std::size_t i : cameras)
    observations.push_back({&rig.cameras[i].camera, *truth.cameras[i].camera.project(point)});
  return triangulate(observations, {})->position;
}

}  // namespace wiimote_tracker::geometry::test
