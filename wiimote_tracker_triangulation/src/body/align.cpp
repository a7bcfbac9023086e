#include "body/align.h"

#include <Eigen/SVD>

namespace wiimote_tracker::body {

Alignment align(const PointPair* pairs, std::size_t count) {
  double weight = 0.0;
  Eigen::Vector3d body_mean = Eigen::Vector3d::Zero();
  Eigen::Vector3d world_mean = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < count; ++i) {
    weight += pairs[i].weight;
    body_mean += pairs[i].weight * pairs[i].in_body;
    world_mean += pairs[i].weight * pairs[i].in_world;
  }
  body_mean /= weight;
  world_mean /= weight;
  Eigen::Matrix3d cross_covariance = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < count; ++i)
    cross_covariance += pairs[i].weight * (pairs[i].in_world - world_mean) *
                        (pairs[i].in_body - body_mean).transpose();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(cross_covariance,
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d signs(1.0, 1.0, 1.0);
  if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0.0)
    signs.z() = -1.0;

  Alignment alignment{Eigen::Isometry3d::Identity(), 0.0};
  alignment.world_from_body.linear() =
      svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
  alignment.world_from_body.translation() =
      world_mean - alignment.world_from_body.linear() * body_mean;
  for (std::size_t i = 0; i < count; ++i)
    alignment.cost +=
        pairs[i].weight *
        (pairs[i].in_world - alignment.world_from_body * pairs[i].in_body).squaredNorm();
  return alignment;
}

}  // namespace wiimote_tracker::body
