#include "changed_rig.h"

#include "wave_trial.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cmath>
#include <cstddef>

namespace wiimote_tracker {

namespace {

using wave::camerasOf;

double rmsLength(const Eigen::Matrix3Xd& columns) {
  return std::sqrt(columns.colwise().squaredNorm().mean());
}

}  // namespace

double volumeError(const std::vector<geometry::RigCamera>& truth, const geometry::Rig& rig) {
  const std::vector<geometry::Camera> cameras = camerasOf(truth);
  return rmsLength(wave::pointErrors(cameras, camerasOf(rig.cameras), wave::cubePoints(cameras)));
}

Movement movementOf(const std::vector<geometry::RigCamera>& truth,
                    const geometry::Rig& from,
                    const geometry::Rig& to) {
  const std::vector<geometry::Camera> cameras = camerasOf(truth);
  const std::vector<Eigen::Vector3d> points = wave::cubePoints(cameras);
  Eigen::Matrix3Xd places(3, static_cast<Eigen::Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i)
    places.col(static_cast<Eigen::Index>(i)) = points[i];
  const Eigen::Matrix3Xd before =
      places + wave::pointErrors(cameras, camerasOf(from.cameras), points);
  const Eigen::Matrix3Xd after = places + wave::pointErrors(cameras, camerasOf(to.cameras), points);
  const Eigen::Affine3d together(Eigen::umeyama(before, after, true));
  return {rmsLength(after - before), rmsLength(after - together * before)};
}

}  // namespace wiimote_tracker
