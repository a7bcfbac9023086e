#pragma once

#include "wiimote_tracker_calibration/square/sightings.h"
#include "wiimote_tracker_calibration/square/square_layout.h"
#include "wiimote_tracker_calibration/square/square_model.h"

#include <wiimote_tracker_triangulation/geometry/camera.h>
#include <wiimote_tracker_triangulation/geometry/camera_parameters.h>
#include <wiimote_tracker_triangulation/geometry/linear_algebra.h>
#include <wiimote_tracker_triangulation/geometry/rig.h>
#include <wiimote_tracker_triangulation/geometry/so3.h>

#include <Eigen/Geometry>

#include <cmath>
#include <optional>
#include <random>
#include <string>
#include <vector>

namespace wiimote_tracker::square {

/// How far the truth is from what the solver starts from: not at all.
inline Uncertainty noErrors() {
  return {0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, std::nullopt};
}

/// True cameras and what they saw of a square.
struct SimulatedSquare {
  std::vector<geometry::Camera> truth;
  std::vector<CameraSightings> sightings;
};

using Random = std::mt19937_64;

inline double uniform(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

inline double normal(Random& random, double stddev) {
  return stddev > 0.0 ? std::normal_distribution<double>(0.0, stddev)(random) : 0.0;
}

inline Eigen::Vector3d anyDirection(Random& random) {
  return Eigen::Vector3d(normal(random, 1.0), normal(random, 1.0), normal(random, 1.0))
      .normalized();
}

/// Cameras with the given poses in front of the square; their starting intrinsics are the default.
/// @param errors of what the solver starts from and measures
inline SimulatedSquare simulateSquare(const std::vector<Eigen::Isometry3d>& world_from_camera,
                                      const SquareLayout& layout,
                                      bool z_up,
                                      const Uncertainty& errors,
                                      bool with_gravity,
                                      Random& random) {
  SimulatedSquare result;
  Corners corners = layout.corners(z_up);
  for (Eigen::Vector3d& corner : corners)
    corner +=
        Eigen::Vector3d(normal(random, errors.placement), normal(random, errors.placement), 0);
  const double shared_x = normal(random, errors.shared_principal_point);
  const double shared_y = normal(random, errors.shared_principal_point);
  for (std::size_t i = 0; i < world_from_camera.size(); ++i) {
    geometry::Camera camera;
    camera.name = "camera_" + std::to_string(i + 1);
    camera.world_from_camera = world_from_camera[i];
    const double scale = std::exp(normal(random, errors.focal));
    const double aspect = std::exp(0.5 * normal(random, errors.aspect));
    camera.intrinsics.fx *= scale * aspect;
    camera.intrinsics.fy *= scale / aspect;
    camera.intrinsics.cx += shared_x + normal(random, errors.principal_point);
    camera.intrinsics.cy += shared_y + normal(random, errors.principal_point);
    camera.intrinsics.distortion[0] += normal(random, errors.k1);
    result.truth.push_back(camera);

    CameraSightings sightings;
    sightings.name = camera.name;
    for (std::size_t c = 0; c < 4; ++c) {
      const Eigen::Vector2d noise(normal(random, errors.pixel), normal(random, errors.pixel));
      sightings.corners[c] = camera.project(corners[c]).value() + noise;
    }
    if (with_gravity) {
      const Eigen::Vector3d up(normal(random, errors.gravity), normal(random, errors.gravity),
                               z_up ? 1.0 : -1.0);
      sightings.gravity = 9.81 * (camera.world_from_camera.linear().transpose() * up).normalized();
    }
    result.sightings.push_back(sightings);
  }
  return result;
}

inline SquareLayout rectangle(double side_x, double side_y) {
  SquareLayout layout;
  layout.side_x = side_x;
  layout.side_y = side_y;
  return layout;
}

inline SquareLayout paperSquare() {
  return rectangle(2.5, 2.5);
}

/// Poses round the square, above the floor, that look at its middle.
inline std::vector<Eigen::Isometry3d> posesAround(const SquareLayout& layout,
                                                  bool z_up,
                                                  std::size_t count,
                                                  Random& random) {
  const double z = z_up ? 1.0 : -1.0;
  const Corners corners = layout.corners(z_up);
  const Eigen::Vector3d middle = 0.5 * (corners[0] + corners[2]);
  const double size = (corners[2] - corners[0]).norm();
  std::vector<Eigen::Isometry3d> poses;
  for (std::size_t i = 0; i < count; ++i) {
    const double angle = uniform(random, -M_PI, M_PI);
    const double distance = size * uniform(random, 1.4, 2.2);
    const Eigen::Vector3d position(middle.x() + distance * std::cos(angle),
                                   middle.y() + distance * std::sin(angle),
                                   middle.z() + z * size * uniform(random, 0.4, 1.2));
    const Eigen::Vector3d target =
        middle + 0.05 * size * Eigen::Vector3d(uniform(random, -1, 1), uniform(random, -1, 1), 0.0);
    Eigen::Isometry3d pose = geometry::lookAt(position, target, Eigen::Vector3d(0.0, 0.0, z));
    pose.linear() =
        pose.linear() * Eigen::AngleAxisd(uniform(random, -0.3, 0.3), Eigen::Vector3d::UnitZ());
    poses.push_back(pose);
  }
  return poses;
}

/// The rig of the paper's Fig. 1, z up: 2.5 m cube, cameras on its diagonals, 4.5 m from the edges,
/// aimed a little below the centre so that every corner is in view. A fifth and more stand between.
inline std::vector<Eigen::Isometry3d> paperRig(std::size_t cameras = 4) {
  std::vector<Eigen::Isometry3d> poses;
  const Eigen::Vector3d center(1.25, 1.25, 1.0);
  const double distance = 4.5 + 1.25 * std::sqrt(2.0);
  for (std::size_t i = 0; i < cameras; ++i) {
    const double angle = (i < 4 ? M_PI / 4.0 : 0.0) + static_cast<double>(i) * M_PI / 2.0;
    const Eigen::Vector3d position(1.25 + distance * std::cos(angle),
                                   1.25 + distance * std::sin(angle), 2.0);
    poses.push_back(geometry::lookAt(position, center, Eigen::Vector3d::UnitZ()));
  }
  return poses;
}

inline double rotationBetween(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  return geometry::so3::angleBetween(a.linear(), b.linear());
}

/// What has to be added to the parameters of one camera to get those of another, in the order of a
/// rig's covariance; the time offset is left at 0.
inline Eigen::Matrix<double, geometry::kParameters, 1> parameterDifference(
    const geometry::Camera& from,
    const geometry::Camera& to) {
  const geometry::Intrinsics& a = from.intrinsics;
  const geometry::Intrinsics& b = to.intrinsics;
  Eigen::Matrix<double, geometry::kParameters, 1> delta;
  delta << geometry::so3::log(to.world_from_camera.linear() *
                              from.world_from_camera.linear().transpose()),
      to.center() - from.center(), b.fx - a.fx, b.fy - a.fy, b.cx - a.cx, b.cy - a.cy,
      Eigen::Map<const Eigen::Matrix<double, 5, 1>>(b.distortion.data()) -
          Eigen::Map<const Eigen::Matrix<double, 5, 1>>(a.distortion.data()),
      0.0;
  return delta;
}

/// NEES of a camera's pose in a rig with covariance: 6 if that is right.
inline double poseNees(const geometry::Rig& rig,
                       std::size_t camera,
                       const geometry::Camera& truth) {
  const Eigen::Index first = geometry::firstParameter(camera);
  return geometry::squaredMahalanobis(
      parameterDifference(rig.cameras[camera].camera, truth).head<6>(),
      rig.covariance.block<6, 6>(first, first));
}

}  // namespace wiimote_tracker::square
