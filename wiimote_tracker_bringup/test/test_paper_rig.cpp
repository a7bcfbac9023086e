// The rig of the paper's Fig. 1: where its cameras stand, and that all of them see everything that
// the paper measures.

#include "description.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace wiimote_tracker::simulation {
namespace {

using Eigen::Vector3d;

std::vector<Vector3d> testPoints() {
  std::vector<Vector3d> points = {Vector3d(1.25, 1.25, 0.0), Vector3d(1.25, 1.25, 1.5)};
  for (const double x : {0.0, 2.5}) {
    for (const double y : {0.0, 2.5}) {
      for (const double z : {0.0, 2.5})
        points.push_back(Vector3d(x, y, z));
    }
  }
  return points;
}

std::vector<Vector3d> circlePoints() {
  std::vector<Vector3d> points;
  for (const Vector3d& center :
       {Vector3d(1.0, 1.0, 0.23), Vector3d(1.5, 1.5, 0.23), Vector3d(1.25, 1.25, 0.95)}) {
    for (int degree = 0; degree < 360; ++degree) {
      const double angle = degree * M_PI / 180.0;
      points.push_back(center + 0.75 * Vector3d(std::cos(angle), std::sin(angle), 0.0));
    }
  }
  return points;
}

class PaperRig : public testing::Test {
 protected:
  const Description description_ = readDescription(SIMULATION_FOLDER "/paper_rig.yaml");
};

TEST_F(PaperRig, stands_as_in_figure_1) {
  ASSERT_EQ(description_.cameras.size(), 4u);
  const Vector3d edges[] = {{0.0, 0.0, 2.0}, {2.5, 0.0, 2.0}, {2.5, 2.5, 2.0}, {0.0, 2.5, 2.0}};
  const Vector3d axis(1.25, 1.25, 2.0);
  for (int i = 0; i < 4; ++i) {
    const geometry::Camera& camera = description_.cameras[i].camera;
    EXPECT_EQ(camera.name, "wiimote_" + std::to_string(i + 1));
    EXPECT_NEAR((camera.center() - edges[i]).norm(), 4.5, 1e-4);
    EXPECT_NEAR((camera.center() - axis).norm(), 6.268, 1e-3);
    // The optical axis meets the cube's axis.
    const Vector3d forward = camera.world_from_camera.linear().col(2);
    EXPECT_NEAR(forward.cross(axis - camera.center()).normalized().dot(Vector3d::UnitZ()), 0.0,
                1e-9);
  }
}

TEST_F(PaperRig, sees_every_test_point_and_every_circle_with_every_camera) {
  std::vector<Vector3d> points = testPoints();
  const std::vector<Vector3d> circles = circlePoints();
  points.insert(points.end(), circles.begin(), circles.end());
  for (const CameraDescription& camera : description_.cameras) {
    for (const Vector3d& point : points) {
      const auto pixel = camera.camera.project(point);
      ASSERT_TRUE(pixel);
      // Inside by three standard deviations of the noise and 5 mm of misplacement.
      EXPECT_TRUE(pixel->x() > 3.0 && pixel->x() < 1020.0 && pixel->y() > 3.0 && pixel->y() < 764.0)
          << camera.camera.name << " misses " << point.transpose() << ", at " << pixel->transpose();
    }
  }
}

TEST_F(PaperRig, lenses_differ_from_the_papers_as_documented) {
  double focal = 0.0, center = 0.0, k1 = 0.0;
  for (const CameraDescription& camera : description_.cameras) {
    const geometry::Intrinsics& lens = camera.camera.intrinsics;
    focal += std::pow(lens.fx / 1306.3 - 1.0, 2) / 4;
    center += (std::pow(lens.cx - 535.0, 2) + std::pow(lens.cy - 401.7, 2)) / 8;
    k1 += std::pow(lens.distortion[0], 2) / 4;
    EXPECT_NEAR(lens.fy / lens.fx, 1302.3 / 1306.3, 1e-6);
  }
  // Within a factor of two of 3 %, 15 px and 0.02: four cameras only.
  EXPECT_GT(std::sqrt(focal), 0.015);
  EXPECT_LT(std::sqrt(focal), 0.06);
  EXPECT_GT(std::sqrt(center), 7.5);
  EXPECT_LT(std::sqrt(center), 30.0);
  EXPECT_GT(std::sqrt(k1), 0.01);
  EXPECT_LT(std::sqrt(k1), 0.04);
}

TEST_F(PaperRig, clocks_and_links_are_those_of_real_remotes) {
  for (std::size_t i = 0; i < 4; ++i) {
    const auto& timing = description_.cameras[i].timing;
    EXPECT_EQ(0.010035, timing.period);
    EXPECT_EQ(500e-6, timing.period_tolerance) << "each camera has its own rate";
    EXPECT_GE(timing.drops, 0.03);
    EXPECT_LE(timing.drops, 0.05);
    for (std::size_t j = 0; j < i; ++j)
      EXPECT_NE(timing.phase, description_.cameras[j].timing.phase);
  }
}

}  // namespace
}  // namespace wiimote_tracker::simulation
