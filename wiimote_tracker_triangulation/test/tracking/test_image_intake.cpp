// Which images before and after a new rig can be combined.
#include "tracking/image_intake.h"
#include "tracking/scene.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>

namespace wiimote_tracker::tracking {
namespace {

/// A rig that knows the time offset of its first camera in one epoch of its clock [s].
geometry::Rig rigWith(double offset, std::uint32_t clock_epoch) {
  geometry::Rig rig = test::paperRig();
  rig.cameras[0].time_offset = offset;
  rig.cameras[0].time_offset_rule = geometry::TimeOffsetRule::kOneEpoch;
  rig.cameras[0].time_offset_epoch = clock_epoch;
  return rig;
}

CameraImage imageAt(double time, std::uint32_t clock_epoch) {
  CameraImage image;
  image.stamp = image.arrival = time;
  image.clock_epoch = clock_epoch;
  return image;
}

TEST(ImageIntake, ComparesTimeOffsetsInThePresentEpochOfAClock) {
  ImageIntake intake(0.001);
  TimedImage timed;
  intake.setRig(rigWith(0.25, 0));
  intake.take(0, imageAt(1000.0, 1), {}, &timed);
  EXPECT_EQ(timed.time, 1000.0);
  EXPECT_TRUE(intake.setRig(rigWith(0.0, 1)));
  EXPECT_FALSE(intake.setRig(rigWith(0.25, 1)));
}

TEST(ImageIntake, UsesACameraAtOnceWhoseNewClockANewRigKnows) {
  ImageIntake intake(0.001);
  TimedImage timed;
  intake.setRig(rigWith(-0.25, 0));
  double now = 1000.0;
  const auto takeOfFirst = [&](int images) {
    auto result = ImageIntake::Result::kUsable;
    for (int i = 0; i < images; ++i, now += 0.01) {
      for (std::size_t camera = 3; camera > 0; --camera)
        intake.take(camera, imageAt(now, 0), {}, &timed);
      result = intake.take(0, imageAt(now + 0.25, 1), {}, &timed);
    }
    return result;
  };
  EXPECT_EQ(takeOfFirst(100), ImageIntake::Result::kWrongClock);
  intake.setRig(rigWith(-0.25, 1));
  EXPECT_EQ(takeOfFirst(1), ImageIntake::Result::kUsable);
}

}  // namespace
}  // namespace wiimote_tracker::tracking
