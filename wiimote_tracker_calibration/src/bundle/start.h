#pragma once

#include "wiimote_tracker_calibration/bundle/solve.h"

#include <Eigen/Geometry>

#include <opencv2/core/types.hpp>

#include <cstddef>
#include <map>
#include <utility>
#include <vector>

namespace wiimote_tracker::bundle {

/// Factor on the error of an outlier while poses and lenses are start values, or a camera was just
/// added.
constexpr double kStartTolerance = 4.0;

/// Some of the points, numbered anew: at random, but those that many cameras saw first, until each
/// two cameras share `enough`, or all that they share.
Reconstruction thinned(const Reconstruction& all, std::size_t enough);

/// What each camera saw, on its normalised image plane (x/z, y/z), by point. Pixels without a ray
/// are left out.
using NormalizedViews = std::vector<std::map<std::size_t, Eigen::Vector2d>>;

NormalizedViews normalize(const Reconstruction& reconstruction);

/// Views of the points that two cameras saw, in the order of the points.
struct CommonViews {
  std::vector<cv::Point2d> first;
  std::vector<cv::Point2d> second;
};

CommonViews commonViews(const std::map<std::size_t, Eigen::Vector2d>& first,
                        const std::map<std::size_t, Eigen::Vector2d>& second);

/// Mean distance of the second view from the best homography of the first, in the unit of the
/// views: 0 if the points lie in a plane. Each distance is limited to 10 times the inliers'
/// tolerance.
double distanceFromPlane(const CommonViews& common, double tolerance);

using CameraPair = std::pair<std::size_t, std::size_t>;

/// Pairs of cameras to start from, the best first: many common points, and views that no plane
/// explains.
std::vector<CameraPair> likelyPairs(const Reconstruction& observed, const Options& options);

/// Estimates the relative pose of two cameras from their common points (essential matrix, Nister
/// 2004), makes the first the world and the baseline 1, and marks both as placed. @returns false if
/// the points are too few, lie on a line in an image, or contradict each other.
bool placePair(const Options& options, const CameraPair& pair, Reconstruction* reconstruction);

/// The camera that sees most known points of those not placed.
/// @throws BundleError when it sees too few of them.
std::size_t nextToResect(const Options& options, const Reconstruction& reconstruction);

/// Estimates the pose of one camera from known points (resection), and marks it as placed.
/// @returns the number of inliers. @throws BundleError: points on a line, or too few inliers.
std::size_t resect(const Options& options, std::size_t camera, Reconstruction* reconstruction);

}  // namespace wiimote_tracker::bundle
