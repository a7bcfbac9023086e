// Other lights than the LED do not move a rig that corrects itself.

#include "misled_trial.h"
#include "waved_led.h"

#include "continuous/continuous_calibration.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <cstdint>
#include <optional>
#include <vector>

namespace wiimote_tracker::continuous {
namespace {

using square::Random;

/// Another light than the LED, where it is at this time [s].
using Light = Eigen::Vector3d (*)(const wave::SimulatedPath& path, double time);

TEST(ExtensiveContinuous, IsNotMisledByAnotherLight) {
  const std::vector<Light> lights = {
      // Mirror images: in the floor, in a window.
      [](const auto& path, double time) -> Eigen::Vector3d {
        return path.position(time, 0).cwiseProduct(Eigen::Vector3d(1.0, 1.0, -1.0));
      },
      [](const auto& path, double time) -> Eigen::Vector3d {
        const Eigen::Vector3d led = path.position(time, 0);
        return {4.0 - led.x(), led.y(), led.z()};
      },
      // Another LED: on its own way, and carried with the first.
      [](const auto& path, double time) -> Eigen::Vector3d { return path.position(time + 7.0, 0); },
      [](const auto& path, double time) -> Eigen::Vector3d {
        return path.position(time, 0) + Eigen::Vector3d(0.2, 0.1, -0.1);
      },
      // A lamp.
      [](const auto&, double) -> Eigen::Vector3d {
        return {1.2, 1.0, 0.5};
      }};
  Random random(5);
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const geometry::Rig rig = paperRigWith(wellCalibrated());
    WavedLed led(drawTruth(rig, random), 500 + i);
    const geometry::RigCamera& misled = led.truth[i % 4];
    ContinuousCalibration watch(rig, {});
    std::optional<Proposal> proposal;
    led.runUntil(40.0, [&](capture::Image image) {
      if (image.camera == misled.camera.name) {
        const double time = image.stamp - WavedLed::kClock + misled.time_offset;
        const auto pixel = misled.camera.project(lights[i](led.path, time));
        image.spots.clear();
        if (pixel)
          image.spots.emplace_back(pixel->array().round());
      }
      if (!proposal)
        proposal = watch.add(image);
    });
    EXPECT_FALSE(proposal) << i << ": " << proposal->message;
  }
}

TEST(ExtensiveContinuous, OtherLightsNeverMakeTheRigAMillimetreWorse) {
  for (const Misled by : {Misled::kMirror, Misled::kOtherLed, Misled::kCarried, Misled::kLamp,
                          Misled::kMasked, Misled::kTwoLights}) {
    for (std::uint64_t seed = 1; seed <= 2; ++seed)
      EXPECT_LT(runMisledTrial(by, seed).worse, 0.001) << static_cast<int>(by) << ' ' << seed;
  }
}

// Most images show another LED 0.35 m from the first, in two cameras or in one.
TEST(Continuous, AnotherLedCarriedAlongIsNotTakenForDrift) {
  for (const std::uint64_t seed : {63, 136, 147})
    EXPECT_EQ(runMisledTrial(Misled::kCarried, seed).changes, 0) << seed;
}

}  // namespace
}  // namespace wiimote_tracker::continuous
