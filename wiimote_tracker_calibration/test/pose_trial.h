#pragma once

#include "square/planar_pose.h"

#include <wiimote_tracker_triangulation/geometry/camera.h>

#include <Eigen/Core>

#include <array>
#include <random>
#include <vector>

namespace wiimote_tracker {

namespace square {

/// cornerPoses() of a camera that saw all four.
inline PlanarPoses planarPoses(const geometry::Intrinsics& intrinsics,
                               const std::array<Eigen::Vector2d, 4>& pixels,
                               const Corners& corners) {
  return cornerPoses(intrinsics, {pixels[0], pixels[1], pixels[2], pixels[3]}, corners);
}

}  // namespace square

/// A camera in front of a square, and what it saw.
struct PoseTrial {
  geometry::Camera truth;
  square::Corners corners;                ///< The square lies round the world's origin [m].
  std::array<Eigen::Vector2d, 4> pixels;  ///< With noise [px].
  double tilt;                            ///< Line of sight against the square's normal [rad].
};

constexpr double kPosePixelStddev = 0.5;  // [px]

/// Side 0.5 to 2.5 m, range 4 to 8 m, any roll, anywhere in the image as long as all of the square
/// is in it, pixel noise of kPosePixelStddev.
/// @param least_tilt, most_tilt uniform between them [rad].
PoseTrial drawPoseTrial(std::mt19937_64& random,
                        const geometry::Intrinsics& lens,
                        double least_tilt,
                        double most_tilt);

/// All minima of the reprojection error that Levenberg-Marquardt with numerical derivatives finds
/// from the truth, its mirror image and `starts` random poses: distinct ones, best first.
std::vector<square::PlanarPose> multiStartPoses(const PoseTrial& trial,
                                                int starts,
                                                std::mt19937_64& random);

/// Sums over trials of planarPoses() beside multiStartPoses().
struct PoseTally {
  int poses = 0;
  int wrong = 0;  ///< Best poses that belong to another of the minima than the truth does.
  int wrong_multi_start = 0;
  /// Trials of which the truth is so well determined that errors are Gaussian: rotation known to
  /// 1.5 degrees (Cramer-Rao), and no second minimum within 80 in chi^2.
  int judged = 0;
  double nees = 0.0;
  double worst_excess = 0.0;  ///< Of the best cost over the multi-start's [chi^2].
  int missed = 0;             ///< Second minima within 80 in chi^2 that only the multi-start found.

  void add(const PoseTrial& trial,
           const square::PlanarPoses& found,
           const std::vector<square::PlanarPose>& minima);
  /// Errors of the judged poses in standard deviations, RMS over the six parameters.
  double whitened() const;
};

}  // namespace wiimote_tracker
