#pragma once

#include "wiimote_tracker_triangulation/geometry/camera.h"
#include "wiimote_tracker_triangulation/geometry/sight.h"

#include <gtest/gtest.h>

namespace wiimote_tracker::geometry::test {

/// Expects that the derivatives of the camera's pixels by the point [m], and of its sights by the
/// pixel, are those of finite differences.
inline void expectDerivatives(const Camera& camera, const Eigen::Vector3d& point) {
  Eigen::Matrix<double, 2, 3> by_point;
  const auto pixel = camera.project(point, &by_point);
  ASSERT_TRUE(pixel);
  const auto sight = sightFromPixel(camera, *pixel);
  ASSERT_TRUE(sight);
  constexpr double kStep = 1e-5;
  for (int a = 0; a < 3; ++a) {
    const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(a);
    const Eigen::Vector2d slope =
        (*camera.project(point + step) - *camera.project(point - step)) / (2.0 * kStep);
    EXPECT_LT((slope - by_point.col(a)).norm(), 1e-4);
  }
  constexpr double kPixelStep = 0.01;
  for (int a = 0; a < 2; ++a) {
    const Eigen::Vector2d step = kPixelStep * Eigen::Vector2d::Unit(a);
    const Eigen::Vector3d slope = (sightFromPixel(camera, *pixel + step)->direction -
                                   sightFromPixel(camera, *pixel - step)->direction) /
                                  (2.0 * kPixelStep);
    EXPECT_LT((slope - sight->directionByPixel().col(a)).norm(), 1e-9);
  }
}

}  // namespace wiimote_tracker::geometry::test
