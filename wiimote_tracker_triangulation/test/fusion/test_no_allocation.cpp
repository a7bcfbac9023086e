// Nothing on the way from a blob to a point allocates, once warm.
#include "geometry/random_rigs.h"
#include "wiimote_tracker_triangulation/fusion/instant_fuser.h"
#include "wiimote_tracker_triangulation/geometry/triangulate.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>
#include <new>

namespace {
int g_allocations = 0;
}  // namespace

// Never inlined: the compiler would see free() on memory that came from new.
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++g_allocations;
  if (void* memory = std::malloc(size))
    return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

namespace wiimote_tracker {
namespace {

using geometry::test::Random;

TEST(NoAllocation, TheCounterCounts) {
  const int before = g_allocations;
  const auto something = std::make_unique<std::vector<int>>(3);
  EXPECT_EQ(3u, something->size());
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

TEST(NoAllocation, InstantFuser) {
  Random random(92);
  const geometry::Rig rig = geometry::test::randomRig(random, 4);
  fusion::InstantFuser fuser(rig, {});
  std::vector<Eigen::Vector2d> pixels;
  for (const geometry::RigCamera& camera : rig.cameras)
    pixels.push_back(*camera.camera.project({0.1, 0.2, 0.3}));
  tracking::CameraImage image;
  image.spots.resize(1);
  int points = 0;
  int before = 0;
  for (int i = 0; i < 1000; ++i) {
    if (i == 500)
      before = g_allocations;
    for (std::size_t c = 0; c < 4; ++c) {
      image.stamp = 100.0 + 0.01 * i + 0.002 * static_cast<double>(c);
      image.arrival = image.stamp + 0.01;
      image.spots[0].pixel = pixels[c];
      if (c == 3 && i % 2)
        image.spots[0].pixel.x() += 300.0;  // leaving a camera out must not allocate either
      fuser.add(c, image);
      while (const tracking::Snapshot* snapshot = fuser.next())
        points += !snapshot->leds.empty();
    }
  }
  const int after = g_allocations;
  EXPECT_EQ(before, after);
  EXPECT_GT(points, 3900);
}

}  // namespace
}  // namespace wiimote_tracker
