// One track, without the images of a tracker.
#include "tracking/track.h"

#include <gtest/gtest.h>

namespace wiimote_tracker::tracking {
namespace {

TEST(Track, ThatHasEndedReacquiresNoOther) {
  // The other would become a copy of it, and end as well.
  const TrackerOptions options;
  const std::size_t cameras = 3;
  Track track({options.motion, 0.0, Eigen::Vector3d::Zero(), 1e-4 * Eigen::Matrix3d::Identity()},
              1);
  for (std::size_t camera = 0; camera < cameras; ++camera)
    track.addInitialSpot(camera, 0.0, 0.0);
  track.predict(0.01);
  track.hit(0, Eigen::Vector2d::Zero(), nullptr, true);
  track.updateStatus(0.01, options, false);
  EXPECT_FALSE(track.isFinished());
  EXPECT_TRUE(track.mayReacquire());

  for (const double time : {0.015, 0.025}) {
    for (std::size_t camera = 0; camera < cameras; ++camera)
      track.miss(camera, time);
  }
  track.updateStatus(0.025, options, false);
  EXPECT_TRUE(track.isFinished());
  EXPECT_FALSE(track.mayReacquire());
}

}  // namespace
}  // namespace wiimote_tracker::tracking
