#include "wiimote_tracker_calibration/square/planar_pose.h"

#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>

namespace wiimote_tracker::square {

namespace {

constexpr double kSameAngle = 3.5e-4;   // [rad]
constexpr double kSameDistance = 2e-4;  // [1]

Eigen::Matrix3d rotationFromVector(const cv::Mat& vector) {
  cv::Mat rotation;
  cv::Rodrigues(vector, rotation);
  Eigen::Matrix3d result;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column)
      result(row, column) = rotation.at<double>(row, column);
  }
  return result;
}

}  // namespace

std::vector<Eigen::Isometry3d> planarPoses(const CameraSightings& sightings,
                                           const Corners& corners) {
  std::vector<cv::Point3d> in_plane;
  std::vector<cv::Point2d> normalized;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const auto undistorted = sightings.intrinsics.normalizedFromPixel(*sightings.corners[i]);
    if (!undistorted)
      return {};
    normalized.emplace_back(undistorted->x(), undistorted->y());
    in_plane.emplace_back(corners[i].x(), corners[i].y(), 0.0);
  }
  std::vector<cv::Mat> rotations;
  std::vector<cv::Mat> translations;
  try {
    cv::solvePnPGeneric(in_plane, normalized, cv::Mat::eye(3, 3, CV_64F), cv::noArray(), rotations,
                        translations, false, cv::SOLVEPNP_IPPE);
  } catch (const cv::Exception&) {
    return {};
  }
  std::vector<Eigen::Isometry3d> poses;
  for (std::size_t i = 0; i < rotations.size(); ++i) {
    Eigen::Isometry3d camera_from_plane = Eigen::Isometry3d::Identity();
    camera_from_plane.linear() = rotationFromVector(rotations[i]);
    for (int row = 0; row < 3; ++row)
      camera_from_plane.translation()(row) = translations[i].at<double>(row);
    if (!camera_from_plane.matrix().allFinite())
      continue;
    const Eigen::Translation3d world_from_plane(0.0, 0.0, corners[0].z());
    poses.push_back(world_from_plane * camera_from_plane.inverse());
  }
  return poses;
}

bool isSamePose(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b, const Corners& corners) {
  const Eigen::AngleAxisd turn(a.linear().transpose() * b.linear());
  const double distance = (a.translation() - 0.5 * (corners[0] + corners[2])).norm();
  return std::abs(turn.angle()) < kSameAngle &&
         (a.translation() - b.translation()).norm() < kSameDistance * distance;
}

}  // namespace wiimote_tracker::square
