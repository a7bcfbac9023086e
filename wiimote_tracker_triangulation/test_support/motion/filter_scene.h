#pragma once

#include "geometry/random_rigs.h"
#include "motion/motion_filter.h"

#include <algorithm>
#include <cmath>
#include <vector>

/// Four cameras that see a moving LED, for tests of the motion filter.
namespace wiimote_tracker::motion::test {

const MotionOptions kDefault{};
constexpr double kPixelStddev = 0.5;
constexpr double kStep = 0.0025;  // from one camera's image to the next camera's [s]

/// Four cameras about the origin, 4.2 m away.
inline std::vector<geometry::Camera> ring() {
  std::vector<geometry::Camera> cameras(4);
  for (int i = 0; i < 4; ++i) {
    const double angle = M_PI / 4.0 + i * M_PI / 2.0;
    cameras[i].world_from_camera =
        geometry::lookAt({4.1 * std::cos(angle), 4.1 * std::sin(angle), 1.0},
                         Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ());
  }
  return cameras;
}

inline Eigen::Vector2d noisyPixel(const geometry::Camera& camera,
                                  const Eigen::Vector3d& point,
                                  geometry::test::Random& random) {
  const double u = random.gaussian();
  return *camera.project(point) + kPixelStddev * Eigen::Vector2d(u, random.gaussian());
}

/// Takes an image as a tracker does. False when the LED is not in front of the camera.
inline bool takeIn(MotionFilter* filter,
                   double time,
                   const geometry::Camera& camera,
                   const Eigen::Vector2d& pixel) {
  filter->predict(time);
  const auto prediction = filter->predictPixel(camera, {kPixelStddev, 0.0});
  return prediction && filter->update(camera, *prediction, pixel);
}

inline double restProbability(const MotionFilter& filter) {
  return filter.modes()[0].probability + filter.modes()[1].probability;
}

inline double relative(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return (a - b).norm() / b.norm();
}

/// A path with rest, a sudden start, a curve and a sudden stop.
inline Eigen::Vector3d variedPath(double time) {
  if (time < 0.5)
    return {0.2, 0.1, 0.3};
  if (time < 0.8)
    return Eigen::Vector3d(0.2, 0.1, 0.3) + (time - 0.5) * Eigen::Vector3d(1.0, 0.5, -0.3);
  const double angle = std::min(3.0 * (time - 0.8), 2.0);
  return {0.5 + 0.4 * std::sin(angle), 0.25 + 0.4 * (1.0 - std::cos(angle)), 0.21};
}

}  // namespace wiimote_tracker::motion::test
