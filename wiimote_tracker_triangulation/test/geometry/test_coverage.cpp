#include "geometry/coverage.h"
#include "geometry/random_rigs.h"
#include "geometry/uncertain_rigs.h"
#include "wiimote_tracker_triangulation/geometry/error.h"
#include "wiimote_tracker_triangulation/geometry/triangulate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace wiimote_tracker::geometry {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;
using test::Random;

AlignedBox3d boxAround(const Vector3d& center, const Vector3d& sides) {
  return {center - 0.5 * sides, center + 0.5 * sides};
}

TEST(Coverage, DividesTheWholeBoxAndCountsTheCameras) {
  Random random(5);
  const Rig rig = test::randomRig(random, 4);
  const auto cells = coverageOf(rig, {boxAround(Vector3d::Zero(), {8.0, 8.0, 5.2}), 0.5}, 0.5);
  ASSERT_EQ(cells.size(), 16U * 16U * 11U);
  EXPECT_EQ(cells.front().center, Vector3d(-3.75, -3.75, -2.35));
  double covered = 0.0;
  for (const CoverageCell& cell : cells) {
    const auto seeing =
        std::count_if(rig.cameras.begin(), rig.cameras.end(),
                      [&](const RigCamera& camera) { return camera.camera.sees(cell.center); });
    EXPECT_EQ(cell.cameras, static_cast<std::size_t>(seeing));
    EXPECT_TRUE(cell.cameras >= 2 || std::isnan(cell.stddev));
    covered += cell.cameras >= 2 ? 1.0 / static_cast<double>(cells.size()) : 0.0;
  }
  EXPECT_GT(covered, 0.1);
  EXPECT_LT(covered, 0.9);
  EXPECT_NEAR(coveredShare(cells), covered, 1e-9);
  EXPECT_EQ(coveredShare({}), 0.0);
}

TEST(Coverage, RefusesTooManyCells) {
  EXPECT_THROW(CellGrid(boxAround(Vector3d::Zero(), {1e6, 1e6, 1e6}), 0.5), Error);
}

TEST(Coverage, FindsTheCellOfAPoint) {
  const CellGrid grid(boxAround(Vector3d::Zero(), {3.0, 2.0, 1.2}), 0.5);
  ASSERT_EQ(grid.count(), 6U * 4U * 3U);
  for (std::size_t i = 0; i < grid.count(); ++i)
    EXPECT_EQ(grid.cellAt(grid.center(i) + Vector3d(0.2, -0.2, 0.2)), i);
  EXPECT_FALSE(grid.cellAt({-1.6, 0.0, 0.0}));
  EXPECT_FALSE(grid.cellAt({0.0, 1.1, 0.0}));
  EXPECT_FALSE(grid.cellAt({0.0, 0.0, std::nan("")}));
}

TEST(Coverage, FindsTheCameraThatLooksAside) {
  Rig rig;
  for (const double x : {-4.0, 0.0, 4.0}) {
    RigCamera camera;
    camera.camera.name = std::to_string(rig.cameras.size());
    camera.camera.world_from_camera = lookAt({x, -6.0, 3.0}, Vector3d::Zero(), Vector3d::UnitZ());
    rig.cameras.push_back(camera);
  }
  const CellGrid grid(boxAround(Vector3d::Zero(), {2.0, 2.0, 2.0}), 0.5);
  EXPECT_FALSE(bestTurn(rig, grid));  // all is seen
  rig.cameras.erase(rig.cameras.begin());
  Eigen::Isometry3d& aim = rig.cameras[1].camera.world_from_camera;
  aim = lookAt({4.0, -6.0, 3.0}, Vector3d::Zero(), Vector3d::UnitZ());
  constexpr double kAside = 25.0 * M_PI / 180.0;
  aim.rotate(Eigen::AngleAxisd(kAside, Vector3d::UnitY()));  // to its right
  const double before = coveredShare(coverageOf(rig, grid, 0.5));
  const auto turn = bestTurn(rig, grid);
  ASSERT_TRUE(turn);
  EXPECT_EQ(turn->camera, "2");
  EXPECT_LT(turn->right, -10.0 * M_PI / 180.0);
  aim.rotate(Eigen::AngleAxisd(turn->right, Vector3d::UnitY()))
      .rotate(Eigen::AngleAxisd(turn->up, Vector3d::UnitX()));
  EXPECT_DOUBLE_EQ(coveredShare(coverageOf(rig, grid, 0.5)), turn->share);
  EXPECT_GT(turn->share, before + 0.1);
}

TEST(Coverage, PredictsTheErrorOfPoints) {
  Random random(6);
  Rig rig = test::randomRig(random, 4);
  const auto cells = coverageOf(rig, {boxAround({0.3, 0.1, -0.2}, {0.1, 0.1, 0.1}), 0.1}, 0.8);
  ASSERT_EQ(cells.size(), 1U);
  constexpr int kDraws = 2000;
  double squares = 0.0;
  for (int draw = 0; draw < kDraws; ++draw) {
    std::vector<Observation> seen;
    for (const RigCamera& camera : rig.cameras)
      seen.push_back(
          {&camera.camera, *camera.camera.project(cells[0].center) +
                               0.8 * Eigen::Vector2d(random.gaussian(), random.gaussian())});
    squares += (triangulate(seen, {})->position - cells[0].center).squaredNorm() / kDraws;
  }
  EXPECT_NEAR(cells[0].stddev / std::sqrt(squares), 1.0, 0.05);
  rig.covariance = test::randomCovariance(random, 4);
  EXPECT_GT(coverageOf(rig, {boxAround(cells[0].center, {0.1, 0.1, 0.1}), 0.1}, 0.8)[0].stddev,
            cells[0].stddev);
}

}  // namespace
}  // namespace wiimote_tracker::geometry
