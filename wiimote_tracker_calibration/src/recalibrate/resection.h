#pragma once

#include "recalibrate/recalibrate_camera.h"
#include "seen_path.h"

#include "adjust/camera_blocks.h"
#include "wiimote_tracker_calibration/square/square_model.h"

#include <wiimote_tracker_triangulation/geometry/camera.h>
#include <wiimote_tracker_triangulation/geometry/camera_parameters.h>

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <vector>

namespace wiimote_tracker::recalibrate {

using ParameterMatrix = Eigen::Matrix<double, geometry::kParameters, geometry::kParameters>;
using LensMatrix = Eigen::Matrix<double, adjust::kLensSize, adjust::kLensSize>;

/// What is known of the camera beforehand. The distortion beyond k1 is held, as in a square and in
/// a wave.
struct Prior {
  geometry::Intrinsics lens;
  square::Uncertainty uncertainty;            ///< Of the lens, unless it has a covariance.
  std::optional<LensMatrix> lens_covariance;  ///< Of fx, fy, cx, cy, k1, as the rig has it.
  double time_offset = 0.0;                   ///< [s]

  /// Inverse of lens_covariance.
  LensMatrix lensInformation() const;
};

/// A spot of the camera and the LED's position at its time.
struct Match {
  PathPoint point;  ///< At the time offset at which it was associated.
  Eigen::Vector2d pixel;
  Eigen::Matrix2d whitening;  ///< Of the spot against the expected pixel [1/px].
};

/// Estimate of camera and time offset, with its data.
struct Fit {
  geometry::Camera camera;
  double time_offset = 0.0;   ///< [s]
  double pixel_stddev = 0.0;  ///< As estimated, per axis [px].
  std::vector<Match> matches;
  double duration = 0.0;          ///< Of the camera's images [s].
  std::size_t expected = 0;       ///< Images with spots while the others saw the LED.
  std::size_t undetermined = 0;   ///< Images for which the others' rays were nearly one line.
  std::size_t contradictory = 0;  ///< Images for which they did not meet.
};

/// Pixel of the LED and its derivatives; that by the time offset is the LED's motion. Nothing when
/// the camera does not see it.
std::optional<geometry::Projection> projectionOf(const geometry::Camera& camera,
                                                 const PathPoint& point);

/// Maximum a posteriori pose, lens and time offset. @param images of this camera, ascending.
/// @throws Error: too few images in common with the others, or no pose explains them.
Fit resect(const SeenPath& path,
           const std::vector<capture::Image>& images,
           const geometry::Camera& start,
           const Prior& prior,
           const Options& options);

/// Covariance of the camera's parameters, the others and the stamps' slow errors being exact.
/// @throws Error: the matches leave a parameter open.
ParameterMatrix covarianceOf(const Fit& fit, const Prior& prior);

}  // namespace wiimote_tracker::recalibrate
