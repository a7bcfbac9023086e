// The instants that continuous calibration adjusts to.
#include "waved_led.h"

#include "continuous/keyframes.h"

#include <gtest/gtest.h>
#include <Eigen/Core>

#include <array>
#include <cmath>
#include <cstddef>
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

/// Else the clocks are off: an error of the pixel looks like one of the time, along the velocity.
TEST(Continuous, TheErrorOfAVelocityIsIndependentOfThePixels) {
  constexpr double kPixel = 0.5;     // [px]
  constexpr double kPeriod = 0.025;  // Half that of the keyframes: each camera keeps its phase [s].
  constexpr std::array<double, 4> kStarts = {0.0, 0.003, 0.01, 0.02};  // [s]
  geometry::Rig rig = paperRigWith(RigErrors());
  for (geometry::RigCamera& camera : rig.cameras)
    camera.time_offset = 0.0;
  // A line, which is one in each image, too: across it pixel and velocity are known.
  const Eigen::Vector3d begin(0.5, 1.2, 0.8);
  const Eigen::Vector3d speed(0.5, 0.1, 0.2);  // [m/s]
  square::Random random(12);
  std::array<Eigen::Matrix2d, 4> errors;  // Sums of products: pixel, velocity.
  errors.fill(Eigen::Matrix2d::Zero());
  for (int pass = 0; pass < 40; ++pass) {
    std::vector<capture::Image> images;
    for (int i = 0; i < 120; ++i) {
      for (std::size_t k = 0; k < rig.cameras.size(); ++k) {
        const geometry::Camera& camera = rig.cameras[k].camera;
        const double time = kPeriod * i + kStarts[k];
        const Eigen::Vector2d pixel = camera.project(begin + time * speed).value();
        const Eigen::Vector2d error(square::normal(random, kPixel), square::normal(random, kPixel));
        images.push_back({camera.name, WavedLed::kClock + time, 7, {pixel + error}, {}});
      }
    }
    for (const Keyframe& keyframe : KeyframeSource(rig, images).keyframes(rig, 5.0)) {
      for (const View& view : keyframe.views) {
        const geometry::Camera& camera = rig.cameras[view.camera].camera;
        const Eigen::Vector2d from = camera.project(begin).value();
        const Eigen::Vector2d along = (camera.project(begin + speed).value() - from).normalized();
        const Eigen::Vector2d across(-along.y(), along.x());
        const Eigen::Vector2d error(across.dot(view.pixel - from), across.dot(view.velocity));
        errors[view.camera] += error * error.transpose();
      }
    }
  }
  // Over 2,200 views a correlation has a standard deviation of 0.02. From the spots of the pixel it
  // was 0.2 to 0.7.
  for (const Eigen::Matrix2d& sums : errors)
    EXPECT_LT(std::abs(sums(0, 1)), 0.1 * std::sqrt(sums(0, 0) * sums(1, 1)));
}

}  // namespace
}  // namespace wiimote_tracker::continuous
