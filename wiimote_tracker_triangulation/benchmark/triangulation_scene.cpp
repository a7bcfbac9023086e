#include "triangulation_scene.h"

#include "geometry/random_rigs.h"

#include <Eigen/LU>

#include <cmath>

namespace wiimote_tracker {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using geometry::Camera;

Vector2d pixelOf(const Camera& camera, const Vector3d& point) {
  const Vector3d seen = camera.world_from_camera.linear().transpose() *
                        (point - camera.world_from_camera.translation());
  return {camera.intrinsics.fx * seen.x() / seen.z() + camera.intrinsics.cx,
          camera.intrinsics.fy * seen.y() / seen.z() + camera.intrinsics.cy};
}

/// Trace of the inverse Fisher information, by numerical derivatives [m^2].
double squaredBoundAt(const std::vector<Camera>& cameras, const Vector3d& point) {
  constexpr double kStep = 1e-4;  // [m]
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  for (const Camera& camera : cameras) {
    Eigen::Matrix<double, 2, 3> slope;
    for (int a = 0; a < 3; ++a) {
      const Vector3d step = kStep * Vector3d::Unit(a);
      slope.col(a) =
          (pixelOf(camera, point + step) - pixelOf(camera, point - step)) / (2.0 * kStep);
    }
    information += slope.transpose() * slope;
  }
  return information.inverse().trace() * kBenchmarkPixelStddev * kBenchmarkPixelStddev;
}

}  // namespace

TriangulationScene makeScene(const TriangulationLayout& layout,
                             int cameras,
                             int points,
                             unsigned seed) {
  geometry::test::Random random(seed);
  TriangulationScene scene;
  scene.name = std::string(layout.name) + " " + std::to_string(cameras);
  for (int i = 0; i < cameras; ++i) {
    const double angle = M_PI / 4.0 + i * M_PI / 2.0 + (i < 4 ? 0.0 : M_PI / 4.0);
    Camera camera;
    camera.name = "camera_" + std::to_string(i + 1);
    camera.world_from_camera = geometry::lookAt(
        {layout.distance * std::cos(angle), layout.distance * std::sin(angle), layout.height},
        Vector3d::Zero(), Vector3d::UnitZ());
    scene.cameras.push_back(camera);
  }
  double squared_bound = 0.0;
  for (int i = 0; i < points; ++i) {
    const Vector3d truth = random.inBox(0.5 * layout.side);
    std::vector<Vector2d> pixels;
    for (const Camera& camera : scene.cameras) {
      const double noise_u = random.gaussian();
      const double noise_v = random.gaussian();
      pixels.push_back(pixelOf(camera, truth) + kBenchmarkPixelStddev * Vector2d(noise_u, noise_v));
    }
    squared_bound += squaredBoundAt(scene.cameras, truth);
    scene.truth.push_back(truth);
    scene.pixels.push_back(pixels);
  }
  scene.bound = std::sqrt(squared_bound / points);
  return scene;
}

}  // namespace wiimote_tracker
