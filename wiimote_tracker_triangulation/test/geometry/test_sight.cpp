#include "geometry/random_rigs.h"
#include "opencv_camera.h"
#include "wiimote_tracker_triangulation/geometry/triangulate.h"

#include <gtest/gtest.h>

namespace wiimote_tracker::geometry {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using test::OpenCvCamera;
using test::Random;

TEST(Sight, ResidualIsThatOfTheLensToFirstOrder) {
  Random random(20);
  for (int i = 0; i < 100; ++i) {
    const Camera camera = test::randomRig(random, 1).cameras[0].camera;
    const Vector3d point = random.inBox(1.0);
    const Vector2d offset(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0));
    const Vector2d pixel = OpenCvCamera(camera).project(point) - offset;
    const auto sight = sightFromPixel(camera, pixel);
    ASSERT_TRUE(sight);
    EXPECT_LT((sight->residual(point) - offset).norm(), 5e-3 * offset.norm());
  }
}

}  // namespace
}  // namespace wiimote_tracker::geometry
