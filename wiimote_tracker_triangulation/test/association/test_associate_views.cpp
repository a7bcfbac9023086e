// Spots of several cameras to points, against exhaustive search.
#include "association/associate_views.h"
#include "association/exhaustive.h"
#include "association/simulated_views.h"
#include "wiimote_tracker_triangulation/geometry/shared_views.h"

#include <gtest/gtest.h>

namespace wiimote_tracker::association::test {
namespace {

using Eigen::Vector3d;

constexpr double kRange = 10.0;  // [m]

/// The same points; costs differ by rounding only.
void expectSame(const Division& expected, const Division& found, int frame) {
  EXPECT_NEAR(expected.cost, found.cost, 1e-3 * expected.cost) << "frame " << frame;
  EXPECT_EQ(expected.points, found.points) << "frame " << frame;
}

TEST(AssociateViews, FourLedsInFourCamerasMatchTheBestPermutation) {
  Random random(21);
  const geometry::Rig rig = ringRig(4);
  const AssociationOptions options;
  ViewAssociator associator(rig, sharedViews(rig, kRange), options);
  for (int frame = 0; frame < 40; ++frame) {
    const SimulatedViews views = simulateViews(random, rig, randomLeds(random, rig, 4), {});
    const Association& association = associator.associate(views.views);
    EXPECT_TRUE(association.proven);
    expectSame(bestPermutation(rig, views, options), divisionOf(association, 4), frame);
  }
}

TEST(AssociateViews, MatchesExhaustiveSearchWithMissedAndGhostSpots) {
  Random random(22);
  const geometry::Rig rig = ringRig(4);
  const AssociationOptions options;
  ViewAssociator associator(rig, sharedViews(rig, kRange), options);
  Disturbance disturbance;
  disturbance.dropout = 0.1;
  disturbance.ghosts = 1;
  for (int frame = 0; frame < 40; ++frame) {
    const SimulatedViews views =
        simulateViews(random, rig, randomLeds(random, rig, 4), disturbance);
    const Association& association = associator.associate(views.views);
    EXPECT_TRUE(association.proven);
    expectSame(bestDivision(rig, views, options), divisionOf(association, 4), frame);
  }
}

TEST(AssociateViews, MatchesExhaustiveSearchWhereManyDivisionsFit) {
  // With noise of 3 px and LEDs close together, many divisions are nearly as good.
  Random random(23);
  AssociationOptions options;
  options.pixel_stddev = 3.0;
  options.ghost = 22.0;
  options.point = 22.0;
  options.maximum_pair_chi_squared = 60.0;  // the oracle has no gate
  options.maximum_steps = 100000;
  Disturbance disturbance;
  disturbance.pixel_stddev = 3.0;
  disturbance.dropout = 0.2;
  disturbance.ghosts = 1;
  for (const int cameras : {2, 3, 4}) {
    const geometry::Rig rig = geometry::test::randomRig(random, cameras);
    ViewAssociator associator(rig, sharedViews(rig, kRange), options);
    for (int frame = 0; frame < 60; ++frame) {
      std::vector<Vector3d> leds;
      for (int i = 0; i < 3; ++i)
        leds.push_back(random.inBox(0.15));
      SimulatedViews views = simulateViews(random, rig, leds, disturbance);
      views.views[0].full = frame % 3 == 0;
      views.views[1].watching = frame % 3 != 1 || views.views[1].count > 0;
      const Association& association = associator.associate(views.views);
      EXPECT_TRUE(association.proven);
      expectSame(bestDivision(rig, views, options),
                 divisionOf(association, static_cast<std::size_t>(cameras)), frame);
    }
  }
}

TEST(AssociateViews, MatchesExhaustiveSearchWithOutlyingSpots) {
  Random random(27);
  const geometry::Rig rig = ringRig(4);
  AssociationOptions options;
  options.maximum_pair_chi_squared = 300.0;  // the oracle has no gate
  options.maximum_steps = 100000;
  ViewAssociator associator(rig, sharedViews(rig, kRange), options);
  std::size_t kept = 0;
  for (int frame = 0; frame < 40; ++frame) {
    SimulatedViews views = simulateViews(random, rig, randomLeds(random, rig, 3), {});
    const auto view = static_cast<std::size_t>(random.uniform(0.0, 4.0));
    Eigen::Vector2d& pixel = views.pixels[view][0];
    pixel.x() += random.uniform(2.0, 6.0);  // 4 to 12 standard deviations
    views.sights[view][0] = *geometry::sightFromPixel(rig.cameras[view].camera, pixel);
    const Association& association = associator.associate(views.views);
    EXPECT_TRUE(association.proven);
    expectSame(bestDivision(rig, views, options), divisionOf(association, 4), frame);
    for (const AssociatedPoint& point : association.points)
      kept += point.spots.size();
  }
  EXPECT_GT(kept, 40u * 11u + 3u) << "sometimes it enters";
  EXPECT_LT(kept, 40u * 12u - 3u) << "and sometimes not";
}

TEST(AssociateViews, GivesThePointAndCostOfItsSpots) {
  Random random(24);
  const geometry::Rig rig = ringRig(4);
  const AssociationOptions options;
  ViewAssociator associator(rig, sharedViews(rig, kRange), options);
  const Vector3d led(0.2, -0.3, 1.0);
  SimulatedViews views = simulateViews(random, rig, {led}, {});
  views.views[2].count = 0;  // a miss
  const Association& association = associator.associate(views.views);
  ASSERT_EQ(1u, association.points.size());
  const AssociatedPoint& point = association.points[0];
  ASSERT_EQ(3u, point.spots.size());
  EXPECT_EQ(0u, point.spots[0].view);
  EXPECT_EQ(1u, point.spots[1].view);
  EXPECT_EQ(3u, point.spots[2].view);
  const double stddev = std::sqrt(point.point.covariance.trace());
  EXPECT_LT((point.point.position - led).norm(), 5.0 * stddev);
  const double chi_squared = 3.0 * std::pow(point.point.reprojection_error / 0.5, 2);
  EXPECT_NEAR(options.point + options.miss + chi_squared, association.cost, 1e-9);
  views.views[2].watching = false;
  EXPECT_NEAR(options.point + chi_squared, associator.associate(views.views).cost, 1e-9);
  views.views[2].watching = true;
  views.views[2].full = true;
  EXPECT_NEAR(options.point + chi_squared, associator.associate(views.views).cost, 1e-9);
}

TEST(AssociateViews, RespectsMinimumRays) {
  Random random(25);
  const geometry::Rig rig = ringRig(4);
  AssociationOptions options;
  options.minimum_rays = 3;
  ViewAssociator associator(rig, sharedViews(rig, kRange), options);
  SimulatedViews views = simulateViews(random, rig, {Vector3d(0.2, -0.3, 1.0)}, {});
  views.views[2].count = 0;
  EXPECT_EQ(1u, associator.associate(views.views).points.size());
  views.views[0].count = 0;
  const Association& association = associator.associate(views.views);
  EXPECT_TRUE(association.points.empty());
  EXPECT_EQ(2.0 * options.ghost, association.cost);
}

TEST(AssociateViews, NothingSeen) {
  const geometry::Rig rig = ringRig(3);
  ViewAssociator associator(rig, sharedViews(rig, kRange), {});
  const std::vector<View> views(3);
  const Association& association = associator.associate(views);
  EXPECT_TRUE(association.points.empty());
  EXPECT_EQ(0.0, association.cost);
  EXPECT_TRUE(association.proven);
}

TEST(AssociateViews, ABoundedSearchIsNotProven) {
  Random random(26);
  const geometry::Rig rig = ringRig(4);
  AssociationOptions options;
  // Two LEDs in one plane with two cameras: only the other cameras resolve the ambiguity.
  const Vector3d led(0.2, -0.3, 1.0);
  const Vector3d baseline = rig.cameras[1].camera.center() - rig.cameras[0].camera.center();
  const SimulatedViews views =
      simulateViews(random, rig, {led, led + 0.3 * baseline.normalized()}, {});
  for (const std::size_t bound : {7u, 8u, 1000u}) {  // one step per spot reaches the points
    options.maximum_steps = bound;
    ViewAssociator associator(rig, sharedViews(rig, kRange), options);
    const Association& association = associator.associate(views.views);
    EXPECT_EQ(bound > 8, association.proven);
    EXPECT_LE(association.steps, bound);
    EXPECT_EQ(bound < 8, association.points.empty());
    EXPECT_TRUE(bound < 1000 || association.points.size() == 2);
  }
}

TEST(TypicalCosts, AreThoseOfTheDocumentedDensities) {
  const geometry::Rig rig = ringRig(2);  // images of 1024 x 768 px
  const AssociationOptions costs = typicalCosts(rig, 0.5);
  EXPECT_EQ(0.5, costs.pixel_stddev);
  // 0.1 false detections in 786432 px^2, 0.25 LEDs in 1 m^3, and one miss for nine detections.
  EXPECT_NEAR(30.8525, costs.ghost, 1e-3);
  EXPECT_NEAR(35.5217, costs.point, 1e-3);
  EXPECT_NEAR(4.3944, costs.miss, 1e-3);
  const AssociationOptions least = typicalCosts(rig, 1000.0, 100.0, 0.4);
  EXPECT_EQ(1.0, least.ghost);
  EXPECT_EQ(0.0, least.point);
  EXPECT_EQ(0.0, least.miss);
}

}  // namespace
}  // namespace wiimote_tracker::association::test
