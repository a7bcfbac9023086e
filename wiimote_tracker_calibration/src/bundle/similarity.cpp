#include "wiimote_tracker_calibration/bundle/similarity.h"

#include <wiimote_tracker_triangulation/geometry/linear_algebra.h>
#include <wiimote_tracker_triangulation/geometry/so3.h>

#include <cstddef>

namespace wiimote_tracker::bundle {

namespace {

using Columns = Eigen::Map<const Eigen::Matrix3Xd>;

bool onOneLine(const std::vector<Eigen::Vector3d>& points) {
  const Eigen::Vector3d spread = geometry::spreadOf(points);
  return !(spread(1) > 1e-6 * spread(0));  // also true for NaN
}

}  // namespace

Eigen::Affine3d fitSimilarity(const std::vector<Eigen::Vector3d>& from,
                              const std::vector<Eigen::Vector3d>& to) {
  if (from.size() != to.size() || from.size() < 3)
    throw BundleError("an alignment needs three or more points, as many in both frames");
  const auto count = static_cast<Eigen::Index>(from.size());
  if (onOneLine(from) || onOneLine(to))
    throw BundleError("the points of an alignment must not lie on one line");
  const Columns from_columns(from.front().data(), 3, count);
  const Columns to_columns(to.front().data(), 3, count);
  return Eigen::Affine3d(Eigen::umeyama(from_columns, to_columns, true));
}

Eigen::MatrixXd similarityMotions(const std::vector<Eigen::Vector3d>& points) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points)
    mean += point / static_cast<double>(points.size());
  Eigen::MatrixXd motions(3 * static_cast<Eigen::Index>(points.size()), 7);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d from_mean = points[i] - mean;
    auto rows = motions.middleRows<3>(3 * static_cast<Eigen::Index>(i));
    rows.leftCols<3>().setIdentity();
    rows.middleCols<3>(3) = geometry::so3::skew(from_mean);
    rows.col(6) = from_mean;
  }
  return motions;
}

void transform(const Eigen::Affine3d& similarity, Reconstruction* reconstruction) {
  const Eigen::Matrix3d rotation = similarity.rotation();
  for (geometry::Camera& camera : reconstruction->cameras) {
    const Eigen::Vector3d center = similarity * camera.center();
    camera.world_from_camera.linear() = rotation * camera.world_from_camera.linear();
    camera.world_from_camera.translation() = center;
  }
  for (auto& point : reconstruction->points) {
    if (point)
      point = similarity * *point;
  }
}

}  // namespace wiimote_tracker::bundle
