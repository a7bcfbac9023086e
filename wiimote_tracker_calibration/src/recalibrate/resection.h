#ifndef WIIMOTE_TRACKER_CALIBRATION_SRC_RECALIBRATE_RESECTION_H
#define WIIMOTE_TRACKER_CALIBRATION_SRC_RECALIBRATE_RESECTION_H

#include "seen_path.h"

#include <wiimote_tracker_triangulation/geometry/camera_parameters.h>

#include <wiimote_tracker_triangulation/geometry/camera.h>

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <vector>

namespace wiimote_tracker::recalibrate {

using ParameterVector = Eigen::Matrix<double, geometry::kParameters, 1>;
using ParameterMatrix = Eigen::Matrix<double, geometry::kParameters, geometry::kParameters>;

/// Prior of the camera.
struct Prior {
  geometry::Intrinsics lens;
  /// Of the lens and of the time offset; 0 on the diagonal: held. Pose: not read.
  ParameterMatrix covariance = ParameterMatrix::Zero();
  double time_offset = 0.0;  ///< [s]
};

/// A spot of the camera and the LED's position at its time.
struct Match {
  PathPoint point;  ///< At the time offset at which it was associated.
  Eigen::Vector2d pixel;
};

/// Estimate of camera and time offset, with its data.
struct Fit {
  geometry::Camera camera;
  double time_offset = 0.0;   ///< [s]
  double pixel_stddev = 0.0;  ///< As estimated, per axis [px].
  std::vector<Match> matches;
  double duration = 0.0;          ///< Of the camera's images [s].
  std::size_t expected = 0;       ///< Images with spots while the others saw the LED.
  std::size_t contradictory = 0;  ///< Images for which the others' rays did not meet.
  ParameterMatrix information = ParameterMatrix::Zero();  ///< With the prior's; held: zero.
  ParameterMatrix prior_information = ParameterMatrix::Zero();
  std::vector<Eigen::Index> free;  ///< Parameters that were not held.
};

struct ResectionOptions {
  double pixel = 0.5;     ///< [px]
  double stamp = 0.0003;  ///< [s]
};

/// Derivative of a match's residual (predicted less observed) by the camera's parameters, and its
/// covariance.
struct Linearized {
  Eigen::Vector2d residual;
  geometry::ParameterJacobian jacobian;
  Eigen::Matrix<double, 2, 3> by_point;
  Eigen::Matrix2d covariance;
};

/// Nothing when the camera does not see the point.
std::optional<Linearized> linearize(const geometry::Camera& camera,
                                    const Match& match,
                                    double pixel_stddev,
                                    double stamp_stddev);

/// Maximum a posteriori pose, lens and time offset. @param images of this camera, ascending.
/// @throws RecalibrateError: too few images in common with the others, or no pose explains them.
Fit resect(const SeenPath& path,
           const std::vector<capture::Image>& images,
           const geometry::Camera& start,
           const Prior& prior,
           const ResectionOptions& options);

}  // namespace wiimote_tracker::recalibrate

#endif  // WIIMOTE_TRACKER_CALIBRATION_SRC_RECALIBRATE_RESECTION_H
