#include "pinhole.h"

#include "number_table.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace wiimote_tracker::import {

Pinhole takeApart(const ProjectionMatrix& projection, const std::string& name) {
  const Eigen::Matrix3d left = projection.leftCols<3>();
  const double determinant = left.determinant();
  if (!(std::abs(determinant) > 1e-12 * std::pow(left.norm(), 3)))
    throw ImportError("the projection matrix of " + name + " is singular");
  // RQ decomposition: QR of the rows and columns in reverse order.
  const Eigen::Matrix3d reversed = left.colwise().reverse().transpose();
  const Eigen::HouseholderQR<Eigen::Matrix3d> qr(reversed);
  const Eigen::Matrix3d q = qr.householderQ();
  const Eigen::Matrix3d r = qr.matrixQR().triangularView<Eigen::Upper>();
  Eigen::Matrix3d k = r.transpose().colwise().reverse().rowwise().reverse();
  Eigen::Matrix3d rotation = q.transpose().colwise().reverse();
  for (int i = 0; i < 3; ++i) {
    if (k(i, i) < 0.0) {
      k.col(i) *= -1.0;
      rotation.row(i) *= -1.0;
    }
  }
  if (rotation.determinant() < 0.0)
    rotation *= -1.0;  // the sign of the whole matrix is free
  k /= k(2, 2);
  Pinhole pinhole;
  pinhole.fx = k(0, 0);
  pinhole.fy = k(1, 1);
  pinhole.cx = k(0, 2);
  pinhole.cy = k(1, 2);
  pinhole.skew = k(0, 1);
  pinhole.world_from_camera = Eigen::Isometry3d::Identity();
  pinhole.world_from_camera.linear() = rotation.transpose();
  pinhole.world_from_camera.translation() = -left.inverse() * projection.col(3);
  return pinhole;
}

geometry::Camera rectify(const RecordedCamera& recorded,
                         bool mirrored,
                         std::size_t index,
                         std::vector<Pixels>* frames) {
  ProjectionMatrix projection = *recorded.projection;
  if (mirrored)
    projection.col(2) *= -1.0;
  const Pinhole pinhole = takeApart(projection, recorded.name);

  const geometry::Intrinsics& lens = recorded.intrinsics;
  Eigen::Vector2d low(0.0, 0.0);
  Eigen::Vector2d high(lens.width - 1.0, lens.height - 1.0);
  for (Pixels& pixels : *frames) {
    auto& pixel = pixels[index];
    if (!pixel)
      continue;
    const auto normalized = lens.normalizedFromPixel(*pixel);
    if (!normalized) {
      pixel.reset();
      continue;
    }
    const double u = lens.fx * normalized->x() + lens.cx;
    const double v = lens.fy * normalized->y() + lens.cy;
    pixel = Eigen::Vector2d(u - pinhole.skew / pinhole.fy * (v - pinhole.cy), v);
    low = low.cwiseMin(*pixel);
    high = high.cwiseMax(*pixel);
  }
  const Eigen::Vector2d shift(-std::floor(low.x()), -std::floor(low.y()));
  for (Pixels& pixels : *frames) {
    if (pixels[index])
      *pixels[index] += shift;
  }

  geometry::Camera camera;
  camera.name = recorded.name;
  camera.intrinsics.width = static_cast<int>(std::ceil(high.x() + shift.x())) + 1;
  camera.intrinsics.height = static_cast<int>(std::ceil(high.y() + shift.y())) + 1;
  camera.intrinsics.fx = pinhole.fx;
  camera.intrinsics.fy = pinhole.fy;
  camera.intrinsics.cx = pinhole.cx + shift.x();
  camera.intrinsics.cy = pinhole.cy + shift.y();
  camera.world_from_camera = pinhole.world_from_camera;
  return camera;
}

}  // namespace wiimote_tracker::import
