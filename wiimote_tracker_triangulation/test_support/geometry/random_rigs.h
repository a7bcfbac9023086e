#pragma once

#include "wiimote_tracker_triangulation/geometry/rig.h"

#include <cmath>
#include <random>
#include <string>

namespace wiimote_tracker::geometry::test {

/// Numbers from std::mt19937 by formulas written out here: the standard's distributions give
/// different numbers with different libraries.
class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}

  double uniform(double low, double high) {
    return low + (high - low) * ((engine_() + 0.5) / 4294967296.0);
  }

  double gaussian() {  // Box and Muller
    const double radius = std::sqrt(-2.0 * std::log(uniform(0.0, 1.0)));
    return radius * std::cos(uniform(0.0, 2.0 * M_PI));
  }

  /// Of this standard deviation along each axis.
  Eigen::Vector3d gaussianVector(double stddev) {
    const double x = gaussian();
    const double y = gaussian();
    return stddev * Eigen::Vector3d(x, y, gaussian());
  }

  Eigen::Vector3d inBox(double half_side) {
    const double x = uniform(-half_side, half_side);
    const double y = uniform(-half_side, half_side);
    return {x, y, uniform(-half_side, half_side)};
  }

 private:
  std::mt19937 engine_;
};

/// A random lens similar to a Wii Remote's, with a random image size.
inline Intrinsics randomIntrinsics(Random& random) {
  Intrinsics intrinsics;
  intrinsics.width = static_cast<int>(random.uniform(640, 1920));
  intrinsics.height = static_cast<int>(random.uniform(480, 1080));
  intrinsics.fx = intrinsics.width * random.uniform(0.9, 1.5);
  intrinsics.fy = intrinsics.fx * random.uniform(0.97, 1.03);
  intrinsics.cx = intrinsics.width * random.uniform(0.45, 0.55);
  intrinsics.cy = intrinsics.height * random.uniform(0.45, 0.55);
  intrinsics.distortion = {random.uniform(-0.15, 0.15), random.uniform(-0.05, 0.05),
                           random.uniform(-0.005, 0.005), random.uniform(-0.005, 0.005),
                           random.uniform(-0.02, 0.02)};
  return intrinsics;
}

/// A wide-angle lens: 100 to 130 degrees across the image's width.
inline Intrinsics randomFisheye(Random& random) {
  Intrinsics intrinsics = randomIntrinsics(random);
  intrinsics.distortion_model = DistortionModel::kEquidistant;
  intrinsics.fx = intrinsics.width / random.uniform(100.0, 130.0) * 180.0 / M_PI;
  intrinsics.fy = intrinsics.fx * random.uniform(0.97, 1.03);
  intrinsics.distortion = {random.uniform(-0.05, 0.05), random.uniform(-0.01, 0.01),
                           random.uniform(-0.003, 0.003), random.uniform(-0.001, 0.001), 0.0};
  return intrinsics;
}

/// Cameras on a ring of 3 to 6 m around the origin, one per equal share of the circle, looking
/// roughly at the origin, with random roll.
inline Rig randomRig(Random& random, int cameras) {
  Rig rig;
  for (int i = 0; i < cameras; ++i) {
    // 0.9: two cameras must not face each other exactly.
    const double angle = 2.0 * M_PI * 0.9 * (i + random.uniform(-0.15, 0.15)) / cameras;
    const double distance = random.uniform(3.0, 6.0);
    const Eigen::Vector3d position(distance * std::cos(angle), distance * std::sin(angle),
                                   random.uniform(0.0, 3.0));
    RigCamera camera;
    camera.camera.name = "camera_" + std::to_string(i);
    camera.camera.identity = "00:00:00:00:00:0" + std::to_string(i);
    camera.camera.intrinsics = randomIntrinsics(random);
    camera.camera.world_from_camera = lookAt(position, random.inBox(0.1), Eigen::Vector3d::UnitZ());
    camera.camera.world_from_camera.rotate(
        Eigen::AngleAxisd(random.uniform(-M_PI, M_PI), Eigen::Vector3d::UnitZ()));
    rig.cameras.push_back(camera);
  }
  return rig;
}

}  // namespace wiimote_tracker::geometry::test
