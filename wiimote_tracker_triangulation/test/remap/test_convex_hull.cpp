// The hull, against mixtures of its points, separating planes and closed forms.
#include "wiimote_tracker_triangulation/remap/convex_hull.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace wiimote_tracker::remap {
namespace {

Eigen::Vector3d noise(std::mt19937_64& random, double stddev) {
  std::normal_distribution<double> normal(0.0, stddev);
  const double x = normal(random);
  const double y = normal(random);
  return Eigen::Vector3d(x, y, normal(random));
}

// Two independent tests: a point is inside when weights of the points have their mean there, and
// outside when a plane separates it.
TEST(ConvexHull, holds_all_mixtures_of_its_points_and_nothing_beyond) {
  std::mt19937_64 random(16);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<Eigen::Vector3d> points;
    for (int i = 0; i < 30; ++i)
      points.push_back(noise(random, 1.0));
    const ConvexHull hull(points);
    for (int i = 0; i < 100; ++i) {
      Eigen::Vector3d mixture = Eigen::Vector3d::Zero();
      double sum = 0.0;
      for (const Eigen::Vector3d& point : points) {
        const double weight = std::pow(uniform(random), 8);
        mixture += weight * point;
        sum += weight;
      }
      EXPECT_TRUE(hull.encloses(mixture / sum));
    }
    for (int i = 0; i < 100; ++i) {
      const Eigen::Vector3d direction = noise(random, 1.0).normalized();
      double farthest = -1e9;
      Eigen::Vector3d top = Eigen::Vector3d::Zero();
      for (const Eigen::Vector3d& point : points) {
        if (direction.dot(point) > farthest) {
          farthest = direction.dot(point);
          top = point;
        }
      }
      EXPECT_TRUE(hull.encloses(top));
      EXPECT_FALSE(hull.encloses(top + 1e-6 * direction));
      EXPECT_GT(hull.excess(top + 1e-6 * direction), 0.0);
    }
  }
}

TEST(ConvexHull, a_box_with_points_on_its_faces_is_a_box) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 125; ++i)
    points.push_back(0.5 * Eigen::Vector3i(i % 5, i / 5 % 5, i / 25).cast<double>());
  const ConvexHull hull(points);
  EXPECT_TRUE(hull.encloses({0.0, 0.0, 0.0}));
  EXPECT_TRUE(hull.encloses({2.0, 1.3, 0.7}));
  EXPECT_NEAR(hull.excess({1.0, 1.0, 2.25}), 0.25, 1e-12);
  EXPECT_NEAR(hull.excess({1.0, 1.0, 1.0}), -1.0, 1e-12);
  EXPECT_FALSE(hull.encloses({2.0 + 1e-6, 1.0, 1.0}));
}

TEST(ConvexHull, nothing_is_inside_of_points_without_volume) {
  EXPECT_FALSE(ConvexHull().encloses({0.0, 0.0, 0.0}));
  const ConvexHull flat({{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {1.0, 1.0, 0.0}});
  EXPECT_FALSE(flat.encloses({0.5, 0.5, 0.0}));
  EXPECT_TRUE(std::isinf(flat.excess({0.5, 0.5, 0.0})));
}

TEST(ConvexHull, a_line_leaves_a_box_where_it_must) {
  std::vector<Eigen::Vector3d> corners;
  for (const double z : {0.0, 2.0}) {
    for (const double y : {0.0, 2.0}) {
      for (const double x : {0.0, 2.0})
        corners.emplace_back(x, y, z);
    }
  }
  const ConvexHull box(corners);
  const Eigen::Vector3d inside(0.5, 1.0, 1.0);
  const ConvexHull::Exit right = box.exit(inside, {3.5, 1.0, 1.5});
  EXPECT_NEAR(right.share, 0.5, 1e-12);
  EXPECT_LT((right.normal - Eigen::Vector3d::UnitX()).norm(), 1e-12);
  const ConvexHull::Exit below = box.exit(inside, {0.0, 1.0, -3.0});
  EXPECT_NEAR(below.share, 0.25, 1e-12);
  EXPECT_LT((below.normal + Eigen::Vector3d::UnitZ()).norm(), 1e-12);
}

}  // namespace
}  // namespace wiimote_tracker::remap
