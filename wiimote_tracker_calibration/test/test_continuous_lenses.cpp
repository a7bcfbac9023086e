// Continuous calibration of a rig whose cameras have different lens models.
#include "waved_led.h"

#include "continuous/adjustment.h"

#include <gtest/gtest.h>

#include <vector>

namespace wiimote_tracker::continuous {
namespace {

TEST(Continuous, ARigWithAnEquidistantLensStaysValid) {
  square::Random random(9);
  geometry::Rig rig = paperRigWith(wellCalibrated());
  // The series of the tangent: no distortion.
  geometry::Intrinsics& lens = rig.cameras[0].camera.intrinsics;
  lens.distortion_model = geometry::DistortionModel::kEquidistant;
  lens.distortion = {1.0 / 3.0, 2.0 / 15.0, 17.0 / 315.0, 62.0 / 2835.0, 0.0};
  rig.check();
  WavedLed led(drawTruth(rig, random), 900);
  std::vector<capture::Image> images;
  led.runUntil(30.0, [&](const capture::Image& image) { images.push_back(image); });
  const auto adjusted = adjustRig(rig, images);
  ASSERT_TRUE(adjusted);
  EXPECT_NO_THROW(adjusted->check());
}

}  // namespace
}  // namespace wiimote_tracker::continuous
