// Following a body does not allocate for each image.
#include "allocation_counter.h"
#include "body/body_scene.h"
#include "body/body_tracker.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace wiimote_tracker::body {
namespace {

TEST(BodyTracker, DoesNotAllocateOnceWarm) {
  tracking::test::SceneOptions options;
  options.pixel_noise = 0.5;
  options.delay_jitter = 0.004;  // late images too
  options.hidden = [](std::size_t, std::size_t, double t) { return std::fmod(t, 2.0) > 1.2; };
  tracking::test::Scene scene(tracking::test::paperRig(),
                              test::pathsOf(test::fourLeds(), test::handheld), options, 44);
  BodyTracker tracker(tracking::test::paperRig(), {test::fourLeds()}, BodyTrackerOptions());
  int allocations = 0;
  int counted = 0;
  for (int i = 0; i < 4 * 100 * 8; ++i) {
    tracking::test::SceneImage image = scene.next();
    const int before = g_allocations;
    tracker.take(image.camera, {}, &image.image);
    // Finding it again after a loss may allocate.
    if (i > 4 * 100 * 4 && tracker.bodies()[0] &&
        tracker.bodies()[0]->first_seen < tracker.time() - 0.1) {
      allocations += g_allocations - before;
      ++counted;
    }
  }
  EXPECT_EQ(allocations, 0);
  EXPECT_GT(counted, 800) << "it is known in most images";
  EXPECT_GT(g_allocations, 0) << "they are counted";
}

}  // namespace
}  // namespace wiimote_tracker::body
