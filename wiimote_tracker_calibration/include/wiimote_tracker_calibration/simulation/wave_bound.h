#pragma once

#include "wiimote_tracker_calibration/simulation/simulated_wave.h"

#include <wiimote_tracker_triangulation/geometry/camera.h>

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace wiimote_tracker::wave {

/// RMS errors of points in the volume, noise of their own pixels left out [m].
struct VolumeError {
  double absolute = 0.0;    ///< In the world.
  double rigid = 0.0;       ///< After the best rigid motion.
  double similarity = 0.0;  ///< After the best similarity.
};

/// @param errors of the points, one column each [m].
VolumeError volumeError(const Eigen::Matrix3Xd& errors, const std::vector<Eigen::Vector3d>& points);

/// Cramér-Rao bound of a simulated recording, at the truth. The model is the solver's (a cubic
/// B-spline with the same knots, the same priors), implemented again without the solver's cost
/// functions (adjust/), so that it can reveal their errors.
struct WaveBound {
  /// Of 12 parameters per camera: rotation, position, fx, fy, cx, cy, k1, time offset.
  Eigen::MatrixXd covariance;
  VolumeError volume;
};

/// With the default knots of WaveOptions and stddev of Wand. Of a wave without views it is the
/// bound of the square alone.
/// @param pixel standard deviation of what the cameras report, rounding included [px].
/// @param points that two cameras or more see.
WaveBound waveBound(const WaveScene& scene,
                    const SimulatedWave& wave,
                    double pixel,
                    const std::vector<Eigen::Vector3d>& points);

/// Cramér-Rao bound of a still point that these cameras see [m^2]: the information of its own
/// pixels together with that of the cameras' parameters. Nothing when fewer than two see it.
/// @param covariance of the cameras, as WaveBound::covariance. @param pixel standard deviation of
/// the pixel coordinates of the point, as averaged [px, > 0].
std::optional<Eigen::Matrix3d> pointBound(const std::vector<geometry::Camera>& cameras,
                                          const Eigen::MatrixXd& covariance,
                                          const Eigen::Vector3d& point,
                                          double pixel);

}  // namespace wiimote_tracker::wave
