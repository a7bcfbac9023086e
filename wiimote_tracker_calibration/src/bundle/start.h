#ifndef WIIMOTE_TRACKER_CALIBRATION_SRC_BUNDLE_START_H
#define WIIMOTE_TRACKER_CALIBRATION_SRC_BUNDLE_START_H

#include "wiimote_tracker_calibration/bundle/solve.h"

#include <Eigen/Geometry>

#include <opencv2/core.hpp>

#include <cstddef>
#include <map>
#include <optional>
#include <vector>

namespace wiimote_tracker::bundle {

/// Rays of what each camera saw, on its normalised image plane (x/z, y/z), by point. Pixels
/// without a ray are left out.
using NormalizedViews = std::vector<std::map<std::size_t, Eigen::Vector2d>>;

NormalizedViews normalize(const Reconstruction& reconstruction);

/// Whether a view fills more than a line; the image of a line in space is one.
bool fillsAnArea(const std::map<std::size_t, Eigen::Vector2d>& view);

/// Places of the points that two cameras saw, in the order of the points.
struct CommonViews {
  std::vector<cv::Point2d> first;
  std::vector<cv::Point2d> second;
};

CommonViews commonViews(const std::map<std::size_t, Eigen::Vector2d>& first,
                        const std::map<std::size_t, Eigen::Vector2d>& second);

/// How far the second view is from being a plane's image of the first: mean distance to the best
/// homography, each cut off at 10 times the tolerance for its inliers; in the unit of the views.
double distanceFromPlane(const CommonViews& common, double tolerance);

/// Two cameras and how they stand to each other.
struct Pair {
  std::size_t first = 0;
  std::size_t second = 0;
  Eigen::Isometry3d second_from_first = Eigen::Isometry3d::Identity();  ///< Baseline of length 1.
  double parallax = 0.0;  ///< Sum over the points [rad].
};

/// Poses two cameras from the points they have in common (essential matrix). Nothing when these are
/// too few, lie on a line in an image, or do not agree.
std::optional<Pair> solvePair(const NormalizedViews& views,
                              const Reconstruction& reconstruction,
                              const Options& options,
                              std::size_t first,
                              std::size_t second);

/// Makes the first of the pair the world's frame, and marks both in placed.
void startFrom(const Pair& pair, Reconstruction* reconstruction, std::vector<bool>* placed);

/// Starts from the pair of cameras with the most parallax.
/// @throws BundleError when no pair has enough points in common.
void startFromPair(const NormalizedViews& views,
                   const Options& options,
                   Reconstruction* reconstruction,
                   std::vector<bool>* placed);

/// The camera that is not placed and sees most of the known points.
/// @throws BundleError when it sees too few of them.
std::size_t nextToPlace(const NormalizedViews& views,
                        const Options& options,
                        const Reconstruction& reconstruction,
                        const std::vector<bool>& placed);

/// Poses one camera from the known points (resection), and marks it in placed.
/// @returns how many points agree. @throws BundleError: they are on a line, or too few agree.
std::size_t place(const NormalizedViews& views,
                  const Options& options,
                  std::size_t camera,
                  Reconstruction* reconstruction,
                  std::vector<bool>* placed);

/// Poses nextToPlace(). @throws BundleError as both do.
void placeNext(const NormalizedViews& views,
               const Options& options,
               Reconstruction* reconstruction,
               std::vector<bool>* placed);

}  // namespace wiimote_tracker::bundle

#endif  // WIIMOTE_TRACKER_CALIBRATION_SRC_BUNDLE_START_H
