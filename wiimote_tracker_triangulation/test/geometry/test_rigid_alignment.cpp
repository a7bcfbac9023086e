#include "wiimote_tracker_triangulation/geometry/linear_algebra.h"

#include <gtest/gtest.h>

#include <vector>

namespace wiimote_tracker::geometry {
namespace {

Eigen::Isometry3d somePose() {
  return Eigen::Translation3d(1.0, -2.0, 0.5) *
         Eigen::AngleAxisd(2.5, Eigen::Vector3d(1.0, 2.0, -1.0).normalized());
}

TEST(RigidAlignment, FindsThePoseOfPointsKnownInBothFrames) {
  const Eigen::Isometry3d a_from_b = somePose();
  // Three points: a plane, which a reflection would bring together as well.
  const std::vector<Eigen::Vector3d> in_b{{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.2, 0.7, 0.0}};
  std::vector<Eigen::Vector3d> in_a;
  for (const Eigen::Vector3d& point : in_b)
    in_a.emplace_back(a_from_b * point);
  EXPECT_TRUE(rigidAlignment(in_a, in_b).isApprox(a_from_b, 1e-12));
}

TEST(RigidAlignment, KeepsTheScaleAndCentresWhatIsLarger) {
  const Eigen::Isometry3d a_from_b = somePose();
  const std::vector<Eigen::Vector3d> in_b{{1.0, 0.0, 0.0},  {-1.0, 0.0, 0.0}, {0.0, 2.0, 0.0},
                                          {0.0, -2.0, 0.0}, {0.0, 0.0, 3.0},  {0.0, 0.0, -3.0}};
  std::vector<Eigen::Vector3d> in_a;
  for (const Eigen::Vector3d& point : in_b)
    in_a.emplace_back(a_from_b * (1.1 * point));
  EXPECT_TRUE(rigidAlignment(in_a, in_b).isApprox(a_from_b, 1e-12));
}

}  // namespace
}  // namespace wiimote_tracker::geometry
