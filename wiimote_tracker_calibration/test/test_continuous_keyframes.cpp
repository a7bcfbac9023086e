// The instants that continuous calibration adjusts to.
#include "waved_led.h"

#include "continuous/keyframes.h"

#include <gtest/gtest.h>

#include <vector>

namespace wiimote_tracker::continuous {
namespace {

TEST(Continuous, KeyframesSkipPauses) {
  const geometry::Rig rig = paperRigWith(wellCalibrated());
  const auto keyframes = [&](double pause) {
    WavedLed led(rig.cameras, 1100);
    std::vector<capture::Image> images;
    led.runUntil(4.0, [&](capture::Image image) {
      if (image.stamp > WavedLed::kClock + 2.0)
        image.stamp += pause;
      images.push_back(image);
    });
    return KeyframeSource(rig, images).keyframes(rig, 5.0).size();
  };
  EXPECT_GT(keyframes(0.0), 40U);
  // Steps of 0.05 s through ten years would take an hour.
  EXPECT_NEAR(static_cast<double>(keyframes(3e8)), static_cast<double>(keyframes(0.0)), 4.0);
}

TEST(Continuous, KeyframesFollowCurves) {
  const geometry::Rig rig = paperRigWith(wellCalibrated());
  WavedLed led(rig.cameras, 1300, 30.0);
  std::vector<capture::Image> images;
  led.runUntil(10.0, [&](capture::Image image) {
    const geometry::RigCamera& camera = *rig.find(image.camera);
    const double time = image.stamp - WavedLed::kClock + camera.time_offset;
    image.spots.clear();
    if (const auto pixel = camera.camera.project(led.path.position(time, 0)))
      image.spots.push_back(*pixel);
    images.push_back(image);
  });
  const auto keyframes = KeyframeSource(rig, images).keyframes(rig, 5.0);
  EXPECT_GT(keyframes.size(), 100U);
  EXPECT_LT(rmsResidual(keyframes), 0.005);  // Along chords 0.023.
}

}  // namespace
}  // namespace wiimote_tracker::continuous
