// What the residuals of a wave say about the noise and about errors that are not as stated.
#include "wave_scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

namespace wiimote_tracker::wave {
namespace {

TEST(Wave, ResidualsTellTheNoise) {
  // The path of few images fits a good part of their noise.
  WaveScene scene = shortScene();
  const double noise = std::sqrt(scene.pixel * scene.pixel + 1.0 / 12.0);
  for (const std::size_t cameras : {2, 3}) {
    scene.camera_count = cameras;
    double squared = 0.0;
    int count = 0;
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      const square::Solution solution =
          solveWave(simulateWave(scene, seed).recording, optionsFor(scene));
      for (const geometry::RigCamera& camera : solution.rig.cameras) {
        squared += 0.5 * std::pow(camera.residual_px, 2);
        ++count;
      }
    }
    EXPECT_NEAR(std::sqrt(squared / count), noise, 0.03 * noise) << cameras;
  }
}

TEST(Wave, ResidualsOfFewImagesAreNotEnlarged) {
  // The path has more parameters than there are pixels.
  WaveScene scene;
  scene.camera_count = 2;
  scene.rate = 15.0;
  scene.duration = 30.0;
  scene.pixel = 0.0;
  scene.quantized = false;
  scene.wrong_share = 0.0;
  const square::Solution solution = solveWave(simulateWave(scene, 1).recording, optionsFor(scene));
  for (const geometry::RigCamera& camera : solution.rig.cameras)
    EXPECT_LT(camera.residual_px, 0.05);
}

TEST(ExtensiveWave, MisfitIsOneWhereTheErrorsAreStatedRightly) {
  // The expectation is exact for small errors: corners and lenses are fitted, too.
  WaveScene scene = shortScene();
  scene.quantized = false;
  scene.wrong_share = 0.0;
  for (const std::size_t cameras : {2, 4}) {
    scene.camera_count = cameras;
    WaveOptions options = optionsFor(scene);
    options.offset = scene.offset * std::sqrt(2.0 / 3.0);  // of differences of uniform offsets
    const int kSeeds = 20;
    double squared = 0.0;
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed)
      squared += std::pow(solveWave(simulateWave(scene, seed).recording, options).misfit, 2);
    // At least seven degrees of freedom: three standard deviations are allowed.
    EXPECT_NEAR(squared / kSeeds, 1.0, 0.36) << cameras;
  }
}

TEST(ExtensiveWave, MisfitIsOneWherePrincipalPointsShareAnOffset) {
  WaveScene scene = shortScene();
  scene.quantized = false;
  scene.wrong_share = 0.0;
  scene.uncertainty = square::Uncertainty();
  WaveOptions options = optionsFor(scene);
  options.offset = scene.offset * std::sqrt(2.0 / 3.0);  // of differences of uniform offsets
  const int kSeeds = 24;
  double squared = 0.0;
  int contradictions = 0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const square::Solution solution = solveWave(simulateWave(scene, seed).recording, options);
    squared += std::pow(solution.misfit, 2);
    contradictions += solution.contradicts ? 1 : 0;
  }
  // At least fifteen degrees of freedom: three standard deviations are allowed.
  EXPECT_NEAR(squared / kSeeds, 1.0, 0.22);
  EXPECT_EQ(contradictions, 0);
}

TEST(ExtensiveWave, ACornerThatMayLieAnywhereIsNoEvidence) {
  WaveScene scene = shortScene();
  scene.quantized = false;
  scene.wrong_share = 0.0;
  scene.camera_count = 2;
  WaveOptions options = optionsFor(scene);
  options.offset = scene.offset * std::sqrt(2.0 / 3.0);  // of differences of uniform offsets
  options.uncertainty.unknown_corner = 2;
  const int kSeeds = 60;
  double squared = 0.0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed)
    squared += std::pow(solveWave(simulateWave(scene, seed).recording, options).misfit, 2);
  // At least five degrees of freedom: two standard deviations are allowed.
  EXPECT_NEAR(squared / kSeeds, 1.0, 0.17);
}

TEST(Wave, TheFirstCamerasClockIsNoEvidence) {
  // All is given but the second camera's clock, which is off by one standard deviation.
  constexpr double kOffset = 0.005;  // [s]
  WaveScene scene = wandScene();
  scene.uncertainty.focal = scene.uncertainty.aspect = 1e-5;
  scene.uncertainty.principal_point = 1e-3;
  scene.uncertainty.shared_principal_point = 0.0;
  scene.uncertainty.k1 = 1e-6;
  SimulatedWave wave = simulateWave(scene, 3);
  for (Frame& frame : wave.recording.cameras[1].frames)
    frame.stamp += wave.offsets[1] - kOffset;
  WaveOptions options = optionsFor(scene);
  options.offset = kOffset;
  EXPECT_NEAR(solveWave(wave.recording, options).misfit, 1.0, 0.1);
}

TEST(Wave, WhereTheWandLayIsNoEvidence) {
  // Only the second camera's clock is off, by one standard deviation, and nothing else by much.
  // Beyond what is needed are measured: that clock, both LEDs by one pixel coordinate each, and the
  // floor's slope along the wand, by the wand and one accelerometer.
  constexpr double kOffset = 0.005;  // [s]
  constexpr double kMeasured = 4.0;
  WaveScene scene = wandScene();
  scene.rest = 2.5;
  scene.pixel = 0.05;
  scene.quantized = false;
  scene.uncertainty.focal = scene.uncertainty.aspect = 1e-5;
  scene.uncertainty.principal_point = 1e-3;
  scene.uncertainty.k1 = 1e-6;
  scene.uncertainty.gravity = scene.uncertainty.placement = 1e-5;
  SimulatedWave wave = simulateWave(scene, 3);
  wave.recording.cameras[0].sightings.gravity.reset();
  for (Frame& frame : wave.recording.cameras[1].frames)
    frame.stamp += wave.offsets[1] - kOffset;
  WaveOptions options = optionsFor(scene);
  options.offset = kOffset;
  options.uncertainty.gravity = square::Uncertainty().gravity;
  options.uncertainty.placement = square::Uncertainty().placement;
  const square::Solution solution = solveWave(wave.recording, options);
  ASSERT_EQ(solution.rig.method, "floor+wand");
  EXPECT_NEAR(std::pow(solution.misfit, 2), 1.0 / kMeasured, 0.02);
}

}  // namespace
}  // namespace wiimote_tracker::wave
