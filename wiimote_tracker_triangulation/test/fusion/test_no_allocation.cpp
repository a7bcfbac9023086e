// Nothing on the way from a blob to a point allocates, once warm.
#include "allocation_counter.h"
#include "association/assign_spots.h"
#include "association/associate_views.h"
#include "association/simulated_views.h"
#include "geometry/random_rigs.h"
#include "wiimote_tracker_triangulation/fusion/instant_fuser.h"
#include "wiimote_tracker_triangulation/geometry/shared_views.h"
#include "wiimote_tracker_triangulation/geometry/triangulate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <memory>

namespace wiimote_tracker {
namespace {

using geometry::test::Random;

TEST(NoAllocation, TheCounterCounts) {
  const int before = g_allocations;
  const auto something = std::make_unique<Eigen::MatrixXd>(9, 9);
  EXPECT_EQ(81, something->size());
  EXPECT_EQ(before + 2, g_allocations);
}

TEST(NoAllocation, Triangulate) {
  Random random(91);
  const geometry::Rig rig = geometry::test::randomRig(random, 16);
  std::vector<geometry::Observation> observations;
  for (const geometry::RigCamera& camera : rig.cameras)
    observations.push_back({&camera.camera, *camera.camera.project({0.1, 0.2, 0.3})});
  observations[0].pixel.x() += 1.0;
  for (const auto method :
       {geometry::TriangulationMethod::kMeanClosest, geometry::TriangulationMethod::kLeastSquares,
        geometry::TriangulationMethod::kMaximumLikelihood,
        geometry::TriangulationMethod::kReweightedMidpoint}) {
    geometry::TriangulationOptions options;
    options.method = method;
    const int before = g_allocations;
    const auto point = geometry::triangulate(observations, options);
    const int after = g_allocations;
    EXPECT_TRUE(point);
    EXPECT_EQ(before, after);
  }
}

/// Four LEDs in four cameras: all their spots, then fewer and fewer, and lamps in between.
class Lights {
 public:
  Lights() : rig_(association::test::ringRig(4)) {
    leds_ = association::test::randomLeds(random_, rig_, 4);
    disturbance_.dropout = 0.1;
    disturbance_.ghosts = 1;
  }

  const geometry::Rig& rig() const { return rig_; }

  association::test::SimulatedViews next() {
    return association::test::simulateViews(random_, rig_, leds_, disturbance_);
  }

 private:
  Random random_{92};
  geometry::Rig rig_;
  std::vector<Eigen::Vector3d> leds_;
  association::test::Disturbance disturbance_;
};

TEST(NoAllocation, ViewAssociator) {
  Lights lights;
  association::ViewAssociator associator(lights.rig(), geometry::sharedViews(lights.rig(), 10.0),
                                         {});
  std::size_t points = 0;
  int allocations = 0;
  for (int i = 0; i < 1000; ++i) {
    const association::test::SimulatedViews views = lights.next();
    const int before = g_allocations;
    points += associator.associate(views.views).points.size();
    if (i >= 500)
      allocations += g_allocations - before;
  }
  EXPECT_EQ(0, allocations);
  EXPECT_GT(points, 3000u);
}

TEST(NoAllocation, AssignSpots) {
  association::SpotCosts costs;
  costs.reset(association::kMaximumSpots, association::kMaximumTracks, 3.0, 2.0);
  for (std::size_t i = 0; i < costs.spots; ++i)
    costs.pair[i].fill(static_cast<double>(i % 5));
  const int before = g_allocations;
  const auto track_of_spot = association::assignSpots(costs);
  EXPECT_EQ(before, g_allocations);
  EXPECT_NE(association::kFalseDetection, track_of_spot[0]);
}

TEST(NoAllocation, InstantFuser) {
  Lights lights;
  fusion::InstantFuserOptions options;
  options.maximum_absence = 0.02;  // so that LEDs are lost and found
  fusion::InstantFuser fuser(lights.rig(), options);
  tracking::CameraImage image;
  image.spots.reserve(4);
  std::size_t leds = 0;
  std::uint32_t newest_id = 0;
  int allocations = 0;
  for (int i = 0; i < 2000; ++i) {
    const association::test::SimulatedViews views = lights.next();
    const bool is_dark = i % 100 < 10;
    const int before = g_allocations;
    for (std::size_t c = 0; c < views.pixels.size(); ++c) {
      image.stamp = 100.0 + 0.01 * i + 0.002 * static_cast<double>(c);
      image.arrival = image.stamp + 0.01;
      image.spots.resize(is_dark ? 0 : views.pixels[c].size());
      for (std::size_t s = 0; s < image.spots.size(); ++s)
        image.spots[s].pixel = views.pixels[c][s];
      fuser.add(c, image);
      while (const tracking::Snapshot* snapshot = fuser.next()) {
        leds += snapshot->leds.size();
        for (const tracking::TrackedLed& led : snapshot->leds)
          newest_id = std::max(newest_id, led.id);
      }
    }
    if (i >= 1000)
      allocations += g_allocations - before;
  }
  EXPECT_EQ(0, allocations);
  EXPECT_GT(leds, 8000u);
  EXPECT_GT(newest_id, 10u);
}

}  // namespace
}  // namespace wiimote_tracker
