#pragma once

#include "wiimote_tracker_calibration/simulation/simulated_board.h"

#include <wiimote_tracker_triangulation/geometry/camera.h>
#include <wiimote_tracker_triangulation/geometry/so3.h>

#include <cmath>
#include <random>
#include <vector>

namespace wiimote_tracker::intrinsics {

/// The paper's K (2) with a little barrel distortion.
inline geometry::Intrinsics paperCamera() {
  geometry::Intrinsics camera;
  camera.distortion = {-0.08, 0.0, 0.0, 0.0, 0.0};
  return camera;
}

/// A lens of about 120 degrees across the image's width in front of the camera.
inline geometry::Intrinsics fisheye() {
  geometry::Intrinsics camera;
  camera.distortion_model = geometry::DistortionModel::kEquidistant;
  camera.fx = 488.0;
  camera.fy = 486.0;
  camera.cx = 520.0;
  camera.cy = 380.0;
  camera.distortion = {-0.02, 0.01, -0.004, 0.001, 0.0};
  return camera;
}

/// Views all over the image of a wide-angle lens, with this noise [px]; with their poses.
inline Samples fisheyeSamples(const geometry::Intrinsics& camera,
                              std::size_t views,
                              double noise,
                              unsigned seed,
                              std::vector<Eigen::Isometry3d>* poses = nullptr) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Samples samples;
  while (samples.views.size() < views) {
    const double u = uniform(random);
    const Eigen::Vector2d pixel(511.5 + 460.0 * u, 383.5 + 330.0 * uniform(random));
    const auto normalized = camera.normalizedFromPixel(pixel);
    const double distance = 0.5 + 0.15 * uniform(random);
    const double side = M_PI * uniform(random);
    const Eigen::Vector3d tilt_axis(std::cos(side), std::sin(side), 0.0);
    // Turned to the camera, tilted by 20 to 45 degrees.
    const Eigen::Vector3d sight = normalized->homogeneous().normalized();
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() = (geometry::so3::between(Eigen::Vector3d::UnitZ(), sight) *
                     Eigen::AngleAxisd(M_PI / 180.0 * (32.5 + 12.5 * uniform(random)), tilt_axis))
                        .toRotationMatrix();
    pose.translation() = distance * sight - pose.linear() * Eigen::Vector3d(0.15, 0.15, 0.0);
    const BoardView view = simulatedView(camera, pose, noise, random);
    if (view.count() < 12)
      continue;
    samples.views.push_back(view);
    if (poses)
      poses->push_back(pose);
  }
  return samples;
}

}  // namespace wiimote_tracker::intrinsics
