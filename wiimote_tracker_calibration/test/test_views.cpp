// Where cameras saw the LED at one time, and the place that they agree on.
#include "capture/views.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <cmath>
#include <limits>
#include <vector>

namespace wiimote_tracker::capture {
namespace {

TEST(Views, AreInterpolatedBetweenTwoImagesOfOneLight) {
  const std::vector<Spot> spots = {{1.0, {100.0, 200.0}}, {1.02, {104.0, 200.0}}};
  const auto view = viewAt(2, spots, 1.005);
  ASSERT_TRUE(view);
  EXPECT_EQ(view->camera, 2u);
  EXPECT_TRUE(view->pixel.isApprox(Eigen::Vector2d(101.0, 200.0)));
  EXPECT_TRUE(view->velocity.isApprox(Eigen::Vector2d(200.0, 0.0)));
  EXPECT_TRUE(viewAt(2, spots, 1.02));
  for (const double time : {0.99, 1.021})
    EXPECT_FALSE(viewAt(2, spots, time)) << time;
  EXPECT_FALSE(viewAt(2, {}, 1.0));
  EXPECT_TRUE(viewAt(0, {{0.0, {0.0, 0.0}}, {0.99 * kLongestGap, {9.0, 0.0}}}, 0.01));
  EXPECT_FALSE(viewAt(0, {{0.0, {0.0, 0.0}}, {1.01 * kLongestGap, {9.0, 0.0}}}, 0.01));
  EXPECT_TRUE(viewAt(0, {{0.0, {0.0, 0.0}}, {0.02, {0.99 * kLongestJump, 0.0}}}, 0.01));
  EXPECT_FALSE(viewAt(0, {{0.0, {0.0, 0.0}}, {0.02, {1.01 * kLongestJump, 0.0}}}, 0.01));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(viewAt(0, {{0.0, {0.0, 0.0}}, {0.02, {nan, nan}}}, 0.01));
}

/// Three cameras, 3 m from the world's origin and directed at it.
std::vector<geometry::Camera> cameras() {
  geometry::Camera camera;
  camera.intrinsics.width = 1024;
  camera.intrinsics.height = 768;
  camera.intrinsics.fx = camera.intrinsics.fy = 1300.0;
  camera.intrinsics.cx = 511.5;
  camera.intrinsics.cy = 383.5;
  std::vector<geometry::Camera> result;
  for (int i = 0; i < 3; ++i) {
    camera.world_from_camera = Eigen::AngleAxisd(0.25 * M_PI * i, Eigen::Vector3d::UnitY()) *
                               Eigen::Translation3d(0.0, 0.0, -3.0);
    result.push_back(camera);
  }
  return result;
}

TEST(Views, AgreeOnAPlaceWithoutTheOneThatShowsAnotherLight) {
  const std::vector<geometry::Camera> rig = cameras();
  const Eigen::Vector3d place(0.1, -0.2, 0.15);
  std::vector<View> views;
  for (std::size_t i = 0; i < 3; ++i)
    views.push_back({i, *rig[i].project(place), Eigen::Vector2d::Zero()});
  const auto all = locate(rig, views, 6.0, 3);
  ASSERT_TRUE(all);
  EXPECT_EQ(all->views.size(), 3u);
  EXPECT_LT((all->point.position - place).norm(), 1e-6);

  views[1].pixel.y() += 50.0;
  EXPECT_FALSE(locate(rig, views, 6.0, 3));
  const auto others = locate(rig, views, 6.0, 2);
  ASSERT_TRUE(others);
  ASSERT_EQ(others->views.size(), 2u);
  EXPECT_EQ(others->views[0].camera, 0u);
  EXPECT_EQ(others->views[1].camera, 2u);
  EXPECT_LT((others->point.position - place).norm(), 1e-6);

  views.pop_back();
  EXPECT_FALSE(locate(rig, views, 6.0, 2)) << "nobody tells which one is wrong";
}

}  // namespace
}  // namespace wiimote_tracker::capture
