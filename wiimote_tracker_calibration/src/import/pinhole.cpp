#include "wiimote_tracker_calibration/import/pinhole.h"

#include "wiimote_tracker_calibration/import/recording.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <utility>

namespace wiimote_tracker::import {

Pinhole takeApart(const ProjectionMatrix& projection, const std::string& name) {
  const Eigen::Matrix3d left = projection.leftCols<3>();
  const double determinant = left.determinant();
  if (!(std::abs(determinant) > 1e-12 * std::pow(left.norm(), 3)))
    throw ImportError("the projection matrix of " + name + " is singular");
  // RQ decomposition by QR: from (J A)' = Q R follows A = (J R' J)(J Q'), where J reverses rows.
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

Rectification::Rectification(const Recording& recording, std::size_t index, bool mirrored) {
  const RecordedCamera& recorded = recording.cameras[index];
  if (!recorded.projection)
    throw ImportError("there is no projection matrix of " + recorded.name);
  ProjectionMatrix projection = *recorded.projection;
  if (mirrored)
    projection.col(2) *= -1.0;
  pinhole_ = takeApart(projection, recorded.name);
  lens_ = recorded.intrinsics;

  Eigen::Vector2d low(0.0, 0.0);
  Eigen::Vector2d high(lens_.width - 1.0, lens_.height - 1.0);
  for (const Pixels& pixels : recording.frames) {
    const auto pixel = pixels[index] ? (*this)(*pixels[index]) : std::nullopt;
    if (!pixel)
      continue;
    low = low.cwiseMin(*pixel);
    high = high.cwiseMax(*pixel);
  }
  shift_ = {-std::floor(low.x()), -std::floor(low.y())};
  camera_.name = recorded.name;
  camera_.intrinsics.width = static_cast<int>(std::ceil(high.x() + shift_.x())) + 1;
  camera_.intrinsics.height = static_cast<int>(std::ceil(high.y() + shift_.y())) + 1;
  camera_.intrinsics.fx = pinhole_.fx;
  camera_.intrinsics.fy = pinhole_.fy;
  camera_.intrinsics.cx = pinhole_.cx + shift_.x();
  camera_.intrinsics.cy = pinhole_.cy + shift_.y();
  camera_.world_from_camera = pinhole_.world_from_camera;
}

std::optional<Eigen::Vector2d> Rectification::operator()(const Eigen::Vector2d& pixel) const {
  const auto normalized = lens_.normalizedFromPixel(pixel);
  if (!normalized)
    return std::nullopt;
  const double u = lens_.fx * normalized->x() + lens_.cx;
  const double v = lens_.fy * normalized->y() + lens_.cy;
  return Eigen::Vector2d(u - pinhole_.skew / pinhole_.fy * (v - pinhole_.cy), v) + shift_;
}

ShippedCameras shippedCameras(const Recording& recording, const bundle::Options& options) {
  ShippedCameras best;
  std::size_t most = 0;
  for (const bool mirrored : {false, true}) {
    ShippedCameras shipped;
    Recording rectified = recording;
    for (std::size_t camera = 0; camera < recording.cameras.size(); ++camera) {
      const Rectification& rectify =
          shipped.rectifications.emplace_back(recording, camera, mirrored);
      for (Pixels& pixels : rectified.frames)
        pixels[camera] = pixels[camera] ? rectify(*pixels[camera]) : std::nullopt;
    }
    bundle::Reconstruction& reconstruction = shipped.reconstruction = observedBy(rectified);
    for (std::size_t camera = 0; camera < recording.cameras.size(); ++camera)
      reconstruction.cameras[camera] = shipped.rectifications[camera].camera();
    shipped.frames = std::move(rectified.frames);
    bundle::triangulatePoints(&reconstruction, options.maximum_error);
    const auto inliers = static_cast<std::size_t>(
        std::count(reconstruction.inliers.begin(), reconstruction.inliers.end(), true));
    if (inliers > most) {
      most = inliers;
      best = std::move(shipped);
    }
  }
  if (most == 0)
    throw ImportError("Pmatrices.dat does not fit to the points: no point is seen by two cameras");
  return best;
}

}  // namespace wiimote_tracker::import
