#pragma once

#include "body/constellation.h"
#include "wiimote_tracker_triangulation/body/pose_state.h"
#include "wiimote_tracker_triangulation/geometry/camera.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker::body {

/// One camera's spot of one LED.
struct LedObservation {
  const geometry::Camera* camera = nullptr;  ///< Not owned.
  Eigen::Vector3d led;                       ///< In the body's frame [m].
  Eigen::Vector2d pixel;                     ///< Distorted [px].
};

struct BodyPose {
  Eigen::Isometry3d world_from_body;
  PoseCovariance covariance;  ///< Position [m^2], rotation about the world axes [rad^2].
};

struct SolvedPose : BodyPose {
  double reprojection_error;  ///< sqrt(mean(du^2 + dv^2)) [px].
};

/// Maximum-likelihood pose of a body at one time for Gaussian pixel noise: minimises the sum of
/// squared pixel residuals over all cameras and LEDs by Levenberg-Marquardt from `start`. Never
/// allocates.
/// @returns nothing when the pose is not determined: fewer than three observations, an LED behind
/// its camera, or no convergence.
std::optional<SolvedPose> solvePose(const LedObservation* observations,
                                    std::size_t count,
                                    const Eigen::Isometry3d& start,
                                    double pixel_stddev);

/// An LED identified by its blink code.
struct LabelledPoint {
  std::string label;
  Eigen::Vector3d position;    ///< World [m].
  Eigen::Matrix3d covariance;  ///< [m^2], positive definite.
};

/// The pose of a body from labelled points. Nothing when fewer than three of its LEDs are among
/// them, or they lie on a line or do not agree with the constellation.
std::optional<BodyPose> poseFromLabels(const Constellation& constellation,
                                       const std::vector<LabelledPoint>& points);

}  // namespace wiimote_tracker::body
