// Continuous calibration while several cameras have new clocks, as after a start.
#include "waved_led.h"

#include "continuous/continuous_calibration.h"

#include <wiimote_tracker_msgs/text.h>

#include <gtest/gtest.h>

namespace wiimote_tracker::continuous {
namespace {

TEST(Continuous, NoKnockIsFoundAmongNewClocksAndTheyAreNamed) {
  square::Random random(8);
  const geometry::Rig rig = paperRigWith(wellCalibrated());
  WavedLed led(drawTruth(rig, random), 800);
  led.epoch = 8;
  led.truth[1] = turned(led.truth[1], 0.03, random);
  ContinuousCalibration watch(rig, {});
  led.runUntil(40.0, [&](const capture::Image& image) { EXPECT_FALSE(watch.add(image)); });
  EXPECT_EQ(joined(watch.newClocks()), "camera_1, camera_2, camera_3, camera_4");
}

}  // namespace
}  // namespace wiimote_tracker::continuous
