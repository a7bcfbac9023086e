// What a wave is refused for, and the cause that the refusal names.
#include "wave/error.h"
#include "wave/steps.h"

#include "expect_says.h"
#include "wave_scenes.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

namespace wiimote_tracker::wave {
namespace {

/// What solving this scene says when it refuses.
std::string refusal(const WaveScene& scene) {
  return refusal(simulateWave(scene, 1).recording, optionsFor(scene));
}

TEST(WaveRefuses, NothingThatGivesScale) {
  WaveScene scene;
  scene.square = false;
  EXPECT_SAYS(refusal(scene), "the scale is not determined");
}

TEST(WaveRefuses, OneCamera) {
  WaveScene scene;
  scene.camera_count = 1;
  EXPECT_SAYS(refusal(scene), "one camera alone");
}

TEST(WaveRefuses, TooFewImages) {
  WaveScene scene;
  SimulatedWave wave = simulateWave(scene, 1);
  wave.recording.cameras[2].frames.resize(60);
  EXPECT_SAYS(refusal(wave.recording, optionsFor(scene)), "camera_3 saw the LED in");
}

TEST(WaveRefuses, ShortRecording) {
  WaveScene scene;
  scene.duration = 1.8;
  EXPECT_SAYS(refusal(scene), "15 s or more");
}

TEST(WaveRefuses, NoCameraOfALongWaveThatSharesFewSeconds) {
  WaveScene scene;
  scene.duration = 200.0;
  scene.rate = 40.0;
  scene.uncertainty.focal = 0.005;
  SimulatedWave wave = simulateWave(scene, 1);
  CameraRecording& rare = wave.recording.cameras[3];
  rare.sightings.corners = {};
  const double start = wave.recording.span().first;
  rare.frames.erase(std::remove_if(rare.frames.begin(), rare.frames.end(),
                                   [&](const Frame& frame) {
                                     const double time = frame.stamp - start;
                                     return time < 100.0 || time > 105.0;
                                   }),
                    rare.frames.end());
  const StartPoses start_poses = startPoses(wave.recording, optionsFor(scene), 0);
  EXPECT_LT((start_poses.cameras[3].center() - wave.cameras[3].center()).norm(), 0.5);
  rare.frames.resize(40);  // one second
  EXPECT_THROW(startPoses(wave.recording, optionsFor(scene), 0), WaveError);
}

TEST(WaveRefuses, CamerasThatShareNothing) {
  WaveScene scene;
  SimulatedWave wave = simulateWave(scene, 1);
  wave.recording.cameras[3].sightings.corners = {};
  for (Frame& frame : wave.recording.cameras[3].frames)
    frame.stamp += 60.0;
  EXPECT_SAYS(refusal(wave.recording, optionsFor(scene)),
              "camera_4 and the other cameras hardly ever saw the LED at the same time");
}

TEST(ExtensiveWaveRefuses, SlowLed) {
  WaveScene scene;
  std::mt19937_64 random(1);
  SimulatedPath path(0.0, random);
  path.pace = 0.06;
  path.reach *= 0.6;
  scene.duration = 30.0;
  scene.rate = 40.0;
  const SimulatedWave wave = simulateWave(scene, path, random);
  EXPECT_SAYS(refusal(wave.recording, optionsFor(scene)), "wave faster");
}

TEST(WaveRefuses, LedInAPlaneOrOnALine) {
  WaveScene scene = shortScene();
  std::mt19937_64 random(1);
  SimulatedPath path(0.0, random);
  path.reach.y() = 0.002;
  EXPECT_SAYS(refusal(simulateWave(scene, path, random).recording, optionsFor(scene)),
              "in a plane only");
  path.reach.z() = 0.002;
  EXPECT_SAYS(refusal(simulateWave(scene, path, random).recording, optionsFor(scene)),
              "along a line only");
}

TEST(WaveRefuses, MirroredImage) {
  WaveScene scene = shortScene();
  SimulatedWave wave = simulateWave(scene, 1);
  const auto mirror = [](Eigen::Vector2d* pixel) { pixel->x() = 1023.0 - pixel->x(); };
  CameraRecording& camera = wave.recording.cameras[1];
  for (Frame& frame : camera.frames)
    std::for_each(frame.spots.begin(), frame.spots.end(), [&](auto& spot) { mirror(&spot); });
  // The square was captured before: only the wave is mirrored.
  EXPECT_SAYS(refusal(wave.recording, optionsFor(scene)), "mirrored");
  for (auto& corner : camera.sightings.corners)
    mirror(&*corner);
  EXPECT_SAYS(refusal(wave.recording, optionsFor(scene)),
              "but clockwise for camera_2: an image is mirrored");
  // Without corners the images nearly fit to a place on the other side of the LED, and any check
  // may be the first to fail. solveSamples() diagnoses contradictions (samples/diagnose.h).
  camera.sightings.corners = {};
  EXPECT_THROW(solveWave(wave.recording, optionsFor(scene)), WaveContradiction);
}

TEST(WaveRefuses, CameraThatWasMovedAfterTheSquare) {
  WaveScene scene;
  SimulatedWave wave = simulateWave(scene, 1);
  WaveScene moved = scene;
  moved.cameras = scene.poses();
  moved.cameras[2].linear() = moved.cameras[2].linear() *
                              Eigen::AngleAxisd(0.06, Eigen::Vector3d::UnitY()).toRotationMatrix();
  const SimulatedWave after = simulateWave(moved, 1);
  wave.recording.cameras[2].frames = after.recording.cameras[2].frames;
  EXPECT_SAYS(refusal(wave.recording, optionsFor(scene)), "camera_3");
}

TEST(WaveRefuses, AccelerometerThatContradictsItsCamera) {
  const WaveScene scene = wandScene();
  SimulatedWave wave = simulateWave(scene, 3);
  addGravity(&wave);
  Eigen::Vector3d& second = *wave.recording.cameras[1].sightings.gravity;
  second = Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitX()) * second;
  EXPECT_SAYS(refusal(wave.recording, optionsFor(scene)),
              "the world as camera_2 sees it is tilted by");
}

TEST(WaveRefuses, LensThatCannotBe) {
  WaveScene scene = wandScene();
  scene.rate = 100.0;
  scene.uncertainty.focal = 0.005;
  SimulatedWave wave = simulateWave(scene, 1);
  for (CameraRecording& camera : wave.recording.cameras) {
    camera.sightings.intrinsics.fx *= 1.08;
    camera.sightings.intrinsics.fy *= 1.08;
  }
  EXPECT_SAYS(refusal(wave.recording, optionsFor(scene)), "no lens near its starting intrinsics");
}

TEST(WaveRefuses, ValuesOutOfRange) {
  WaveScene scene;
  SimulatedWave wave = simulateWave(scene, 1);
  const WaveOptions options = optionsFor(scene);
  for (const double length : {-0.5, 50.0, std::nan("")}) {  // 0.5 m typed in centimetres
    wave.recording.wand = Wand{length};
    EXPECT_SAYS(refusal(wave.recording, options), "wand_length");
  }
  wave.recording.wand.reset();
  wave.recording.cameras[1].frames.back().stamp += 1e6;
  EXPECT_SAYS(refusal(wave.recording, options), "same clock");
}

}  // namespace
}  // namespace wiimote_tracker::wave
