#pragma once

#include "wiimote_tracker_calibration/bundle/reconstruction.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <vector>

namespace wiimote_tracker::bundle {

/// Similarity with the least sum of squared distances between scale * R * from + t and to
/// (Umeyama 1991). @throws BundleError: sizes differ, fewer than three points, or points (nearly)
/// on one line.
Eigen::Affine3d fitSimilarity(const std::vector<Eigen::Vector3d>& from,
                              const std::vector<Eigen::Vector3d>& to);

/// Small motions of points that a similarity makes, three rows per point, one column for each of
/// its seven parameters: translation, rotation about the points' mean, scale.
Eigen::MatrixXd similarityMotions(const std::vector<Eigen::Vector3d>& points);

/// Applies a similarity to cameras and points; reprojections stay the same.
void transform(const Eigen::Affine3d& similarity, Reconstruction* reconstruction);

}  // namespace wiimote_tracker::bundle
