#include "start.h"

#include "wiimote_tracker_calibration/bundle/error.h"

#include <Eigen/Dense>

#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace wiimote_tracker::bundle {

namespace {

// Before any adjustment lenses and poses are rough: outliers are told apart this many times wider.
constexpr double kStartTolerance = 4.0;

struct Pair {
  std::size_t first = 0;
  std::size_t second = 0;
  Eigen::Isometry3d second_from_first = Eigen::Isometry3d::Identity();
  double parallax = 0.0;  // sum over the points [rad]
};

Eigen::Matrix3d eigenFromCv(const cv::Mat& matrix) {
  Eigen::Matrix3d result;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column)
      result(row, column) = matrix.at<double>(row, column);
  }
  return result;
}

Eigen::Vector3d vectorFromCv(const cv::Mat& column) {
  return {column.at<double>(0), column.at<double>(1), column.at<double>(2)};
}

/// Whether the points of an image fill more than a line; the image of a line in space is one.
bool fillsAnArea(const std::vector<cv::Point2d>& points) {
  Eigen::Matrix2Xd columns(2, static_cast<Eigen::Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i)
    columns.col(static_cast<Eigen::Index>(i)) << points[i].x, points[i].y;
  const Eigen::Matrix2Xd centered = columns.colwise() - columns.rowwise().mean();
  const Eigen::Vector2d spread = centered.jacobiSvd().singularValues();
  const double kThinnest = 0.02;  // width over length
  return spread(1) > kThinnest * spread(0);
}

double focalLength(const geometry::Camera& camera) {
  return 0.5 * (camera.intrinsics.fx + camera.intrinsics.fy);
}

void commonViews(const NormalizedViews& views,
                 std::size_t first,
                 std::size_t second,
                 std::vector<cv::Point2d>* in_first,
                 std::vector<cv::Point2d>* in_second) {
  for (const auto& [point, view] : views[first]) {
    const auto other = views[second].find(point);
    if (other == views[second].end())
      continue;
    in_first->emplace_back(view.x(), view.y());
    in_second->emplace_back(other->second.x(), other->second.y());
  }
}

/// Relative pose of two cameras, if enough of their common points agree on one.
bool solvePair(const NormalizedViews& views,
               const Reconstruction& reconstruction,
               const Options& options,
               Pair* pair) {
  std::vector<cv::Point2d> first;
  std::vector<cv::Point2d> second;
  commonViews(views, pair->first, pair->second, &first, &second);
  if (first.size() < options.minimum_common_points || !fillsAnArea(first) || !fillsAnArea(second))
    return false;
  const double focal_length = 0.5 * (focalLength(reconstruction.cameras[pair->first]) +
                                     focalLength(reconstruction.cameras[pair->second]));
  cv::Mat mask;
  const cv::Mat essential =
      cv::findEssentialMat(first, second, 1.0, cv::Point2d(0.0, 0.0), cv::RANSAC, 0.999,
                           kStartTolerance * options.maximum_error / focal_length, mask);
  if (essential.rows != 3 || essential.cols != 3)
    return false;
  cv::Mat rotation;
  cv::Mat translation;
  const int in_front =
      cv::recoverPose(essential, first, second, rotation, translation, 1.0, {0.0, 0.0}, mask);
  if (in_front < static_cast<int>(options.minimum_common_points))
    return false;
  pair->second_from_first.linear() = eigenFromCv(rotation);
  pair->second_from_first.translation() = vectorFromCv(translation);
  pair->parallax = 0.0;
  for (std::size_t i = 0; i < first.size(); ++i) {
    if (mask.at<unsigned char>(static_cast<int>(i)) == 0)
      continue;
    const Eigen::Vector3d a =
        pair->second_from_first.linear() * Eigen::Vector3d(first[i].x, first[i].y, 1.0);
    const Eigen::Vector3d b(second[i].x, second[i].y, 1.0);
    pair->parallax += std::atan2(a.cross(b).norm(), std::abs(a.dot(b)));
  }
  return true;
}

std::string commonText(const NormalizedViews& views, const Reconstruction& reconstruction) {
  std::string text;
  for (std::size_t i = 0; i < views.size(); ++i) {
    for (std::size_t j = i + 1; j < views.size(); ++j) {
      std::vector<cv::Point2d> first;
      std::vector<cv::Point2d> second;
      commonViews(views, i, j, &first, &second);
      text += (text.empty() ? "" : ", ") + reconstruction.cameras[i].name + " and " +
              reconstruction.cameras[j].name + " " + std::to_string(first.size());
    }
  }
  return text;
}

}  // namespace

NormalizedViews normalize(const Reconstruction& reconstruction) {
  NormalizedViews views(reconstruction.cameras.size());
  for (const Observation& observation : reconstruction.observations) {
    const geometry::Intrinsics& intrinsics = reconstruction.cameras[observation.camera].intrinsics;
    if (const auto normalized = intrinsics.normalizedFromPixel(observation.pixel))
      views[observation.camera][observation.point] = *normalized;
  }
  return views;
}

void startFromPair(const NormalizedViews& views,
                   const Options& options,
                   Reconstruction* reconstruction,
                   std::vector<bool>* placed) {
  Pair best;
  for (std::size_t i = 0; i < views.size(); ++i) {
    for (std::size_t j = i + 1; j < views.size(); ++j) {
      Pair pair;
      pair.first = i;
      pair.second = j;
      if (solvePair(views, *reconstruction, options, &pair) && pair.parallax > best.parallax)
        best = pair;
    }
  }
  if (!(best.parallax > 0.0))
    throw BundleError("no two cameras agree on where they stand; they need " +
                      std::to_string(options.minimum_common_points) +
                      " or more points in common, spread over the room, and have: " +
                      commonText(views, *reconstruction));
  reconstruction->cameras[best.first].world_from_camera = Eigen::Isometry3d::Identity();
  reconstruction->cameras[best.second].world_from_camera = best.second_from_first.inverse();
  (*placed)[best.first] = true;
  (*placed)[best.second] = true;
}

void placeNext(const NormalizedViews& views,
               const Options& options,
               Reconstruction* reconstruction,
               std::vector<bool>* placed) {
  std::size_t next = 0;
  std::vector<cv::Point3d> points;
  std::vector<cv::Point2d> pixels;
  for (std::size_t camera = 0; camera < views.size(); ++camera) {
    if ((*placed)[camera])
      continue;
    std::vector<cv::Point3d> known;
    std::vector<cv::Point2d> seen;
    for (const auto& [index, view] : views[camera]) {
      const auto& point = reconstruction->points[index];
      if (!point)
        continue;
      known.emplace_back(point->x(), point->y(), point->z());
      seen.emplace_back(view.x(), view.y());
    }
    if (points.empty() || known.size() > points.size()) {
      next = camera;
      points = known;
      pixels = seen;
    }
  }
  geometry::Camera& camera = reconstruction->cameras[next];
  const std::string advice = "move the light where " + camera.name +
                             " and two of the others see it, or leave this camera out";
  if (points.size() < options.minimum_common_points)
    throw BundleError(camera.name + " shares " + std::to_string(points.size()) +
                      " points with the cameras placed before it, but needs " +
                      std::to_string(options.minimum_common_points) + ": " + advice);
  if (!fillsAnArea(pixels))
    throw BundleError(
        camera.name +
        " shares only points on one line with the cameras placed before it: " + advice);
  cv::Mat rotation_vector;
  cv::Mat translation;
  std::vector<int> inliers;
  const double tolerance = kStartTolerance * options.maximum_error / focalLength(camera);
  const bool found =
      cv::solvePnPRansac(points, pixels, cv::Mat::eye(3, 3, CV_64F), cv::noArray(), rotation_vector,
                         translation, false, 1000, tolerance, 0.9999, inliers, cv::SOLVEPNP_EPNP);
  if (!found || inliers.size() < options.minimum_common_points)
    throw BundleError("no pose of " + camera.name + " explains what it saw of " +
                      std::to_string(points.size()) +
                      " points: check its intrinsics and its frame numbers; or " + advice);
  cv::Mat rotation;
  cv::Rodrigues(rotation_vector, rotation);
  Eigen::Isometry3d camera_from_world = Eigen::Isometry3d::Identity();
  camera_from_world.linear() = eigenFromCv(rotation);
  camera_from_world.translation() = vectorFromCv(translation);
  camera.world_from_camera = camera_from_world.inverse();
  (*placed)[next] = true;
}

}  // namespace wiimote_tracker::bundle
