// Derivatives of the wave's projection against finite differences, for both lens models.
#include "../src/wave/projection.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <array>

namespace wiimote_tracker::wave {
namespace {

/// The camera with one of its parameters changed, in the order of CameraJacobian.
geometry::Camera moved(geometry::Camera camera, Eigen::Index parameter, double step) {
  geometry::Intrinsics& lens = camera.intrinsics;
  if (parameter < 3)
    camera.world_from_camera.linear() = Eigen::AngleAxisd(step, Eigen::Vector3d::Unit(parameter)) *
                                        camera.world_from_camera.linear();
  else if (parameter < 6)
    camera.world_from_camera.translation()[parameter - 3] += step;
  else
    *std::array<double*, 5>{&lens.fx, &lens.fy, &lens.cx, &lens.cy,
                            &lens.distortion[0]}[static_cast<std::size_t>(parameter - 6)] += step;
  return camera;
}

TEST(WaveProjection, derivativesAreThoseOfFiniteDifferencesForEveryLens) {
  for (const auto model :
       {geometry::DistortionModel::kPlumbBob, geometry::DistortionModel::kEquidistant}) {
    SCOPED_TRACE(geometry::nameOf(model));
    geometry::Camera camera;
    camera.world_from_camera =
        geometry::lookAt({3.0, -2.0, 2.0}, {1.0, 1.0, 0.5}, Eigen::Vector3d::UnitZ());
    camera.intrinsics.fx = camera.intrinsics.fy = 500.0;
    camera.intrinsics.distortion_model = model;
    camera.intrinsics.distortion = {-0.05, 0.01, 0.002, -0.001, 0.0};
    const Eigen::Vector3d point(2.3, 1.5, 0.9);
    Projection projection;
    ASSERT_TRUE(project(camera, point, &projection));
    EXPECT_LT((projection.pixel - *camera.project(point)).norm(), 1e-9);
    constexpr double kStep = 1e-6;
    for (Eigen::Index k = 0; k < kOffset; ++k) {
      const Eigen::Vector2d slope =
          (*moved(camera, k, kStep).project(point) - *moved(camera, k, -kStep).project(point)) /
          (2.0 * kStep);
      EXPECT_LT((projection.by_camera.col(k) - slope).norm(), 1e-4) << k;
    }
  }
}

}  // namespace
}  // namespace wiimote_tracker::wave
