#pragma once

#include "refusal_of.h"
#include "wave_trial.h"
#include "wiimote_tracker_calibration/simulation/simulated_wave.h"
#include "wiimote_tracker_calibration/simulation/wave_bound.h"
#include "wiimote_tracker_calibration/wave/solve_wave.h"

#include <Eigen/Core>

#include <cstddef>
#include <string>

namespace wiimote_tracker::wave {

/// As much data as most tests need; a quarter of the work of the default.
inline WaveScene shortScene() {
  WaveScene scene;
  scene.duration = 8.0;
  scene.rate = 60.0;
  return scene;
}

/// A wand waved before two cameras, without a square.
inline WaveScene wandScene() {
  WaveScene scene = shortScene();
  scene.square = false;
  scene.length = 0.5;
  scene.camera_count = 2;
  return scene;
}

/// Gives each camera an accelerometer that measured gravity at rest.
inline void addGravity(SimulatedWave* wave) {
  for (std::size_t i = 0; i < wave->cameras.size(); ++i)
    wave->recording.cameras[i].sightings.gravity =
        wave->cameras[i].world_from_camera.linear().transpose() * Eigen::Vector3d(0.0, 0.0, 9.81);
}

/// What the solution and the truth differ by in the volume.
inline VolumeError errorOf(const WaveScene& scene,
                           const SimulatedWave& wave,
                           const square::Solution& solution) {
  const auto points = cubePoints(wave.cameras);
  return volumeError(pointErrors(wave.cameras, inTrueWorld(scene, wave, solution), points), points);
}

/// What solving says when it refuses.
inline std::string refusal(const Recording& recording, const WaveOptions& options) {
  return refusalOf([&] { solveWave(recording, options); });
}

}  // namespace wiimote_tracker::wave
