#pragma once

#include <wiimote_tracker_triangulation/geometry/linear_algebra.h>
#include <wiimote_tracker_triangulation/geometry/so3.h>

#include <Eigen/Geometry>

#include <opencv2/core.hpp>

#include <vector>

namespace wiimote_tracker::adjust {

/// A column of three doubles.
inline Eigen::Vector3d vectorFromCv(const cv::Mat& column) {
  return {column.at<double>(0), column.at<double>(1), column.at<double>(2)};
}

/// Camera from world, of the rotation vector and the translation that OpenCV gives.
inline Eigen::Isometry3d poseFromCv(const cv::Mat& rotation_vector, const cv::Mat& translation) {
  Eigen::Isometry3d camera_from_world = Eigen::Isometry3d::Identity();
  camera_from_world.linear() = geometry::so3::exp(vectorFromCv(rotation_vector)).toRotationMatrix();
  camera_from_world.translation() = vectorFromCv(translation);
  return camera_from_world;
}

/// Whether points of a plane cover more than a line: they spread across it by more than 2 % of what
/// they spread along it.
inline bool fillAnArea(const std::vector<cv::Point2d>& points) {
  std::vector<Eigen::Vector3d> in_plane;
  in_plane.reserve(points.size());
  for (const cv::Point2d& point : points)
    in_plane.emplace_back(point.x, point.y, 0.0);
  const Eigen::Vector3d spread = geometry::spreadOf(in_plane);
  return spread(1) > 0.02 * spread(0);
}

}  // namespace wiimote_tracker::adjust
