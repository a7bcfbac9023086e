#pragma once

#include "wiimote_tracker_calibration/intrinsics/board.h"

#include <wiimote_tracker_triangulation/geometry/camera.h>

#include <cmath>
#include <random>

namespace wiimote_tracker::intrinsics {

/// Pixel of an LED of the default board at this pose, by the geometry core; NaN when it has none.
inline Eigen::Vector2d projected(const geometry::Intrinsics& camera,
                                 const Eigen::Isometry3d& camera_from_board,
                                 int led) {
  const Eigen::Vector3d p = camera_from_board * Board().position(led);
  return camera.pixelFromNormalized(p.hnormalized());
}

/// The middle of a board of 0.3 m somewhere in the image, 0.55 to 1 m away, tilted by up to 45
/// degrees to any side and turned by up to 30 degrees.
inline Eigen::Isometry3d randomPose(std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const double depth = 0.775 + 0.225 * uniform(random);
  const double side = 2.0 * M_PI * uniform(random);
  const Eigen::Vector3d tilt_axis(std::cos(side), std::sin(side), 0.0);
  const double tilt = M_PI / 4.0 * (0.7 + 0.3 * uniform(random));
  const double turn = M_PI / 6.0 * uniform(random);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() =
      (Eigen::AngleAxisd(tilt, tilt_axis) * Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()))
          .toRotationMatrix();
  const Eigen::Vector3d middle(0.3 * depth * uniform(random), 0.22 * depth * uniform(random),
                               depth);
  pose.translation() = middle - pose.linear() * Eigen::Vector3d(0.15, 0.15, 0.0);
  return pose;
}

/// What the camera sees, with Gaussian noise [px] and whole pixels; no noise: exact.
inline BoardView simulatedView(const geometry::Intrinsics& camera,
                               const Eigen::Isometry3d& camera_from_board,
                               double noise,
                               std::mt19937& random) {
  std::normal_distribution<double> normal;
  BoardView view;
  for (int led = 0; led < kBoardLeds; ++led) {
    const Eigen::Vector2d exact = projected(camera, camera_from_board, led);
    Eigen::Vector2d seen = exact;
    if (noise > 0.0) {
      seen.x() = std::round(exact.x() + noise * normal(random));
      seen.y() = std::round(exact.y() + noise * normal(random));
    }
    if (camera.isInImage(exact))
      view.pixels[static_cast<std::size_t>(led)] = seen;
  }
  return view;
}

/// Random views that show eight LEDs or more.
inline Samples simulatedSamples(const geometry::Intrinsics& camera,
                                std::size_t views,
                                double noise,
                                unsigned seed) {
  std::mt19937 random(seed);
  Samples samples;
  samples.width = camera.width;
  samples.height = camera.height;
  while (samples.views.size() < views) {
    const BoardView view = simulatedView(camera, randomPose(random), noise, random);
    if (view.count() >= 8)
      samples.views.push_back(view);
  }
  return samples;
}

}  // namespace wiimote_tracker::intrinsics
