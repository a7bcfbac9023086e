#pragma once

#include "wiimote_tracker_triangulation/geometry/camera.h"

#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>

#include <vector>

namespace wiimote_tracker::geometry::test {

/// A camera computed by OpenCV, which shares no code with ours.
struct OpenCvCamera {
  explicit OpenCvCamera(const Camera& camera) {
    const Intrinsics& i = camera.intrinsics;
    K = (cv::Mat_<double>(3, 3) << i.fx, 0, i.cx, 0, i.fy, i.cy, 0, 0, 1);
    D = (cv::Mat_<double>(1, 5) << i.distortion[0], i.distortion[1], i.distortion[2],
         i.distortion[3], i.distortion[4]);
    const Eigen::Matrix3d rotation = camera.world_from_camera.linear().transpose();
    const Eigen::Vector3d t = -rotation * camera.world_from_camera.translation();
    R = cv::Mat_<double>(3, 3);
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c)
        R(r, c) = rotation(r, c);
    }
    translation = (cv::Mat_<double>(3, 1) << t.x(), t.y(), t.z());
    cv::Rodrigues(R, rotation_vector);
  }

  Eigen::Vector2d project(const Eigen::Vector3d& point) const {
    std::vector<cv::Point2d> pixels;
    cv::projectPoints(std::vector<cv::Point3d>{{point.x(), point.y(), point.z()}}, rotation_vector,
                      translation, K, D, pixels);
    return {pixels[0].x, pixels[0].y};
  }

  cv::Mat_<double> K, D, R, translation, rotation_vector;
};

}  // namespace wiimote_tracker::geometry::test
