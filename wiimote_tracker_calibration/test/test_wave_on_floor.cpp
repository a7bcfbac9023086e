// The world of a wand that lies on the floor before it is waved, against simulations whose truth is
// known, and what is refused.
#include "expect_says.h"
#include "refusal_of.h"
#include "wave_scenes.h"

#include "wave/steps.h"

#include <wiimote_tracker_triangulation/geometry/camera_parameters.h>
#include <wiimote_tracker_triangulation/geometry/error.h>
#include <wiimote_tracker_triangulation/geometry/linear_algebra.h>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace wiimote_tracker::wave {
namespace {

WaveScene floorScene() {
  WaveScene scene = shortScene();
  scene.square = false;
  scene.length = 0.5;
  scene.rest = 2.5;
  scene.uncertainty.gravity = 0.01;
  return scene;
}

/// Changes what the cameras saw while the wand lay on the floor.
template <typename Change>
void changeRest(const WaveScene& scene, SimulatedWave* wave, const Change& change) {
  for (std::size_t i = 0; i < wave->recording.cameras.size(); ++i) {
    std::vector<Frame>& frames = wave->recording.cameras[i].frames;
    const double end = frames.front().stamp + scene.rest;
    for (Frame& frame : frames) {
      if (frame.stamp < end)
        change(i, &frame);
    }
  }
}

/// The true cameras and their wand, moved into the world of the floor.
State stood(const WaveScene& scene, const SimulatedWave& wave) {
  Recording recording = wave.recording;
  const FloorSpots spots = takeFloor(&recording);
  State state;
  state.cameras = wave.cameras;
  state.trajectory = Trajectory(0.0, 1.0, 0.05, 2);
  state.wand_length = recording.wand->length;
  useFloorAsWorld({recording, optionsFor(scene), spots}, &state);
  return state;
}

std::string refusal(const WaveScene& scene, const SimulatedWave& wave) {
  return refusalOf([&] { stood(scene, wave); });
}

TEST(WandOnFloor, GivesALevelWorldWithItsOriginAtTheNearerEnd) {
  WaveScene scene = floorScene();
  scene.pixel = 0.0;
  scene.quantized = false;
  scene.wrong_share = 0.0;
  scene.uncertainty.pixel = 1e-3;
  scene.uncertainty.gravity = 1e-4;
  scene.uncertainty.placement = 1e-5;
  SimulatedWave wave = simulateWave(scene, 1);
  wave.recording.wand->led_height = 0.03;
  const square::Solution solution = solveWave(wave.recording, optionsFor(scene));
  EXPECT_EQ(solution.rig.method, "floor+wand");
  EXPECT_EQ(solution.rig.led_height, 0.03);
  for (std::size_t i = 0; i < wave.cameras.size(); ++i) {
    const Eigen::Isometry3d truth = Eigen::Translation3d(0.0, 0.0, 0.03) *
                                    scene.cubeFromFloor().inverse() *
                                    wave.cameras[i].world_from_camera;
    const Eigen::Isometry3d& solved = solution.rig.cameras[i].camera.world_from_camera;
    EXPECT_LT((solved.translation() - truth.translation()).norm(), 2e-3) << i;
    EXPECT_LT(Eigen::AngleAxisd(solved.linear().transpose() * truth.linear()).angle(), 3e-4) << i;
  }
  EXPECT_SAYS(solution.rig.verdict, "in the wand's world, level to 0.0 degrees");
}

TEST(WandOnFloor, WrongSpotsDoNotMatter) {
  WaveScene scene = floorScene();
  scene.wrong_share = 0.1;
  const SimulatedWave wave = simulateWave(scene, 2);
  const square::Solution solution = solveWave(wave.recording, optionsFor(scene));
  const VolumeError error = errorOf(scene, wave, solution);
  EXPECT_LT(error.similarity, 0.004);
  EXPECT_LT(error.absolute, 0.04);
}

constexpr Eigen::Index kCameras = 3;

/// Mean NEES per dimension of the poses of three cameras, over simulated calibrations.
double poseNees(const WaveScene& scene, int seeds) {
  double sum = 0.0;
  for (int seed = 1; seed <= seeds; ++seed) {
    const SimulatedWave wave = simulateWave(scene, static_cast<std::uint64_t>(seed));
    const square::Solution solution = solveWave(wave.recording, optionsFor(scene));
    Eigen::Matrix<double, 6 * kCameras, 1> error;
    Eigen::Matrix<double, 6 * kCameras, 6 * kCameras> covariance;
    for (Eigen::Index i = 0; i < kCameras; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const Eigen::Isometry3d truth =
          scene.cubeFromFloor().inverse() * wave.cameras[at].world_from_camera;
      const geometry::Camera& solved = solution.rig.cameras[at].camera;
      const Eigen::AngleAxisd turn(
          Eigen::Matrix3d(truth.linear() * solved.world_from_camera.linear().transpose()));
      error.segment<3>(6 * i) = turn.angle() * turn.axis();
      error.segment<3>(6 * i + 3) = truth.translation() - solved.center();
      for (Eigen::Index j = 0; j < kCameras; ++j)
        covariance.block<6, 6>(6 * i, 6 * j) = solution.rig.covariance.block<6, 6>(
            geometry::firstParameter(at), geometry::firstParameter(static_cast<std::size_t>(j)));
    }
    sum += geometry::squaredMahalanobis(error, covariance) / (6.0 * static_cast<double>(kCameras));
  }
  return sum / seeds;
}

TEST(ExtensiveWandOnFloor, TheCovarianceIncludesHowTheWorldWasFound) {
  WaveScene scene = floorScene();
  scene.camera_count = static_cast<std::size_t>(kCameras);
  scene.quantized = false;
  const int kSeeds = 16;
  // Three standard deviations of the mean of chi-squared.
  EXPECT_NEAR(poseNees(scene, kSeeds), 1.0,
              3.0 * std::sqrt(2.0 / (6.0 * static_cast<double>(kCameras * kSeeds))));
}

TEST(WandOnFloor, OneAccelerometerIsEnough) {
  const WaveScene scene = floorScene();
  SimulatedWave wave = simulateWave(scene, 3);
  const double all =
      solveWave(wave.recording, optionsFor(scene)).rig.covariance.diagonal().head<2>().sum();
  for (std::size_t i = 0; i < 3; ++i)
    wave.recording.cameras[i].sightings.gravity.reset();
  const square::Solution solution = solveWave(wave.recording, optionsFor(scene));
  EXPECT_GT(solution.rig.covariance.diagonal().head<2>().sum(), 1.5 * all);
  EXPECT_GT(solution.rig.cameras[0].camera.center().z(), 1.8);
  wave.recording.cameras[3].sightings.gravity.reset();
  EXPECT_SAYS(refusal(scene, wave), "no camera has an accelerometer");
}

TEST(WandOnFloor, ACameraThatSeesOneEndOnlyDoesNotCount) {
  const WaveScene scene = floorScene();
  SimulatedWave wave = simulateWave(scene, 4);
  const auto hideFrom = [&](std::size_t first) {
    changeRest(scene, &wave, [&](std::size_t camera, Frame* frame) {
      if (camera >= first && !frame->spots.empty())
        frame->spots.resize(1);
    });
  };
  hideFrom(2);
  EXPECT_NEAR(stood(scene, wave).cameras[3].center().z(), 2.0, 0.02);
  hideFrom(1);
  EXPECT_SAYS(refusal(scene, wave), "only 1 camera saw both LEDs of the wand");
}

TEST(WandOnFloor, AWandThatMovesHasNotBeenLaidDown) {
  const WaveScene scene = floorScene();
  SimulatedWave wave = simulateWave(scene, 5);
  changeRest(scene, &wave, [&](std::size_t, Frame* frame) {
    for (Eigen::Vector2d& spot : frame->spots)
      spot.x() += 20.0 * std::fmod(frame->stamp, 100.0);
  });
  EXPECT_SAYS(refusal(scene, wave), "at rest for 2 s");
}

TEST(WandOnFloor, ACameraThatSeesTwoLampsIsNamed) {
  const WaveScene scene = floorScene();
  SimulatedWave wave = simulateWave(scene, 9);
  for (Frame& frame : wave.recording.cameras[3].frames)
    frame.spots = {Eigen::Vector2d(100.0, 100.0), Eigen::Vector2d(300.0, 200.0)};
  EXPECT_SAYS(refusal(wave.recording, optionsFor(scene)), "camera_4 saw two lights at rest");
}

/// Lays the wand elsewhere: its LEDs in the world of the floor [m].
void layAt(const WaveScene& scene,
           const std::array<Eigen::Vector3d, 2>& leds,
           SimulatedWave* wave) {
  changeRest(scene, wave, [&](std::size_t camera, Frame* frame) {
    frame->spots.clear();
    for (const Eigen::Vector3d& led : leds)
      frame->spots.push_back(wave->cameras[camera].project(scene.cubeFromFloor() * led).value());
  });
}

TEST(WandOnFloor, TheOriginIsTheEndNearerToTheFirstCamera) {
  const WaveScene scene = floorScene();
  SimulatedWave wave = simulateWave(scene, 6);
  const double before = stood(scene, wave).cameras[0].center().x();
  layAt(scene, {Eigen::Vector3d(0.5, 0.0, 0.0), Eigen::Vector3d::Zero()}, &wave);
  const double after = stood(scene, wave).cameras[0].center().x();
  EXPECT_LT(before, -4.0);
  EXPECT_NEAR(after, before, 0.1);
  layAt(scene, {Eigen::Vector3d(0.0, -0.25, 0.0), Eigen::Vector3d(0.0, 0.25, 0.0)}, &wave);
  EXPECT_SAYS(refusal(scene, wave), "about as far from camera_1");
}

TEST(WandOnFloor, AWandOnAStepOrOtherLightsAreRefused) {
  const WaveScene scene = floorScene();
  SimulatedWave wave = simulateWave(scene, 7);
  layAt(scene, {Eigen::Vector3d::Zero(), Eigen::Vector3d(0.48, 0.0, 0.14)}, &wave);
  EXPECT_SAYS(refusal(scene, wave), "16 degrees from level");
  layAt(scene, {Eigen::Vector3d::Zero(), Eigen::Vector3d(1.2, 0.0, 0.0)}, &wave);
  EXPECT_SAYS(refusal(scene, wave), "is not the wand of 0.50 m");
}

/// How often an adjustment was begun before a refusal with these words.
int adjustmentsBefore(const std::string& words, const WaveScene& scene, const SimulatedWave& wave) {
  int begun = 0;
  std::string before;
  try {
    solveWave(wave.recording, optionsFor(scene), [&](const std::string& step, double) {
      begun += step != before && step.find("adjusting") == 0 ? 1 : 0;
      before = step;
    });
    ADD_FAILURE() << "not refused";
  } catch (const geometry::Error& error) {
    EXPECT_SAYS(std::string(error.what()), words);
  }
  return begun;
}

TEST(WandOnFloor, AMistakeIsToldBeforeTheAdjustmentASmallOneAfterIt) {
  const WaveScene scene = floorScene();
  SimulatedWave wave = simulateWave(scene, 8);
  layAt(scene, {Eigen::Vector3d::Zero(), Eigen::Vector3d(0.48, 0.0, 0.14)}, &wave);
  EXPECT_EQ(adjustmentsBefore("16 degrees from level", scene, wave), 0);
  layAt(scene, {Eigen::Vector3d::Zero(), Eigen::Vector3d(1.2, 0.0, 0.0)}, &wave);
  EXPECT_EQ(adjustmentsBefore("is not the wand of 0.50 m", scene, wave), 0);
  layAt(scene, {Eigen::Vector3d::Zero(), Eigen::Vector3d(0.498, 0.0, 0.044)}, &wave);
  EXPECT_EQ(adjustmentsBefore("5 degrees from level", scene, wave), 1);
}

}  // namespace
}  // namespace wiimote_tracker::wave
