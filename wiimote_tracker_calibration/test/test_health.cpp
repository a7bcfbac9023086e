// Whether tilt and drift are noticed, and only these: over many simulated minutes.

#include "waved_led.h"

#include "health/drift_watch.h"
#include "health/tilt_watch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

namespace wiimote_tracker::health {
namespace {

using square::normal;
using square::Random;
using square::uniform;

constexpr double kDegree = M_PI / 180.0;

/// Cameras whose drift reached the limit in the latest judgement.
std::set<std::string> drifted(const geometry::Rig& rig, const DriftWatch& watch) {
  std::set<std::string> names;
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    if (watch.drifts()[i] && watch.drifts()[i]->ratio >= 1.0)
      names.insert(rig.cameras[i].camera.name);
  }
  return names;
}

/// Share of tilts of one size that reach the limit, over cameras in any attitude that are turned
/// about any horizontal axis.
double shareNoticed(double angle, double noise, double step, const TiltOptions& options) {
  Random random(11);
  const int kTrials = 400;
  int noticed = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const Eigen::Vector3d before = 9.81 * square::anyDirection(random);
    const Eigen::Vector3d axis = before.cross(square::anyDirection(random)).normalized();
    const Eigen::Vector3d after = Eigen::AngleAxisd(angle, axis) * before;
    capture::RestGravity calibrated;
    for (int i = 0; i < 200; ++i)
      calibrated.add(reading(before, noise, step, random));
    TiltWatch watch(*calibrated.mean(), options);
    std::optional<Tilt> tilt;
    for (int i = 0; !tilt && i < 300; ++i)
      tilt = watch.add(0.05 * i, reading(after, noise, step, random));
    noticed += tilt && tilt->ratio >= 1.0;
  }
  return static_cast<double>(noticed) / kTrials;
}

TEST(TiltWatch, DetectsTiltsThatTheAccelerometerResolves) {
  // A Wii Remote's y and z count in steps of 0.18 m/s^2, with a noise of 0.03 m/s^2.
  const TiltOptions remote;
  EXPECT_EQ(shareNoticed(0.0, 0.03, 0.18, remote), 0.0);
  EXPECT_LT(shareNoticed(0.2 * kDegree, 0.03, 0.18, remote), 0.01);
  EXPECT_GT(shareNoticed(2.0 * kDegree, 0.03, 0.18, remote), 0.99);
  RecordProperty("noticed_0.5_degrees",
                 std::to_string(shareNoticed(0.5 * kDegree, 0.03, 0.18, remote)));
  RecordProperty("noticed_1_degree",
                 std::to_string(shareNoticed(1.0 * kDegree, 0.03, 0.18, remote)));
  RecordProperty("noticed_1.5_degrees",
                 std::to_string(shareNoticed(1.5 * kDegree, 0.03, 0.18, remote)));
  // One that is finer than its noise.
  TiltOptions fine;
  fine.resolution = 0.01;
  fine.limit = 0.3 * kDegree;
  EXPECT_EQ(shareNoticed(0.0, 0.03, 0.01, fine), 0.0);
  EXPECT_GT(shareNoticed(0.5 * kDegree, 0.03, 0.01, fine), 0.99);
}

TEST(TiltWatch, SaysHowFarAndHowSure) {
  Random random(12);
  const Eigen::Vector3d up(0.0, -9.81, 0.0);
  TiltOptions options;
  options.resolution = 0.01;
  TiltWatch watch(up, options);
  const Eigen::Vector3d tilted = Eigen::AngleAxisd(3.0 * kDegree, Eigen::Vector3d::UnitX()) * up;
  std::optional<Tilt> tilt;
  for (int i = 0; !tilt && i < 300; ++i)
    tilt = watch.add(0.05 * i, reading(tilted, 0.03, 0.01, random));
  ASSERT_TRUE(tilt);
  EXPECT_NEAR(tilt->angle, 3.0 * kDegree, 0.05 * kDegree);
  EXPECT_NEAR(tilt->stddev, 0.01 / std::sqrt(6.0) / 9.81, 1e-9);
  EXPECT_NEAR(tilt->ratio, tilt->angle / options.limit, 1e-12);
}

TEST(TiltWatch, DoesNotJudgeAShakingCamera) {
  Random random(13);
  TiltWatch watch(Eigen::Vector3d(0.0, -9.81, 0.0), {});
  for (int i = 0; i < 1000; ++i)
    EXPECT_FALSE(watch.add(0.05 * i, reading({0.0, -9.0, 4.0}, 1.5, 0.18, random)));
  // Nor by few readings, nor across a clock that went back.
  TiltWatch sparse(Eigen::Vector3d(0.0, -9.81, 0.0), {});
  for (int i = 0; i < 20; ++i)
    EXPECT_FALSE(sparse.add(1.0 * i, {0.0, 0.0, 9.81}));
  TiltWatch back(Eigen::Vector3d(0.0, -9.81, 0.0), {});
  for (int i = 0; i < 190; ++i)
    EXPECT_FALSE(back.add(0.05 * i, {0.0, 0.0, 9.81}));
  for (int i = 0; i < 190; ++i)
    EXPECT_FALSE(back.add(0.05 * i - 100.0, {0.0, -9.81, 0.0}));
}

// Forty minutes of tracking by rigs whose errors are those their covariance tells of.
TEST(ExtensiveDriftWatch, RaisesNoFalseAlarm) {
  Random random(21);
  int judgements = 0;
  int reached = 0;
  for (int trial = 0; trial < 10; ++trial) {
    const std::size_t cameras = trial % 2 == 0 ? 4 : 2;
    // Half of the rigs are calibrated well, half by a square alone.
    const geometry::Rig rig =
        paperRigWith(trial % 4 < 2 ? calibratedByWave() : RigErrors(), cameras);
    WavedLed scene(drawTruth(rig, random), 100 + static_cast<std::uint64_t>(trial));
    DriftWatch watch(rig, {});
    scene.runUntil(240.0, [&](const capture::Image& image) {
      if (!watch.add(image))
        return;
      for (const auto& drift : watch.drifts()) {
        judgements += drift.has_value();
        reached += drift && drift->ratio >= 1.0;
      }
    });
  }
  EXPECT_GT(judgements, 800);
  EXPECT_LE(reached, judgements / 200);
  RecordProperty("judgements", judgements);
  RecordProperty("reached", reached);
}

TEST(ExtensiveDriftWatch, NamesTheCameraThatDriftedByOnePixel) {
  Random random(22);
  const geometry::Rig rig = paperRigWith(calibratedByWave());
  int noticed = 0;
  int named = 0;
  const int kTrials = 24;
  for (int trial = 0; trial < kTrials; ++trial) {
    auto truth = drawTruth(rig, random);
    const std::size_t moved = static_cast<std::size_t>(trial) % 4;
    const double angle = uniform(random, -M_PI, M_PI);
    truth[moved].camera.intrinsics.cx += std::cos(angle);
    truth[moved].camera.intrinsics.cy += std::sin(angle);
    WavedLed scene(truth, 200 + static_cast<std::uint64_t>(trial));
    DriftWatch watch(rig, {});
    scene.runUntil(62.0, [&](const capture::Image& image) { watch.add(image); });
    const auto names = drifted(rig, watch);
    noticed += !names.empty();
    named += names.count(truth[moved].camera.name) == 1;
  }
  RecordProperty("noticed", noticed);
  RecordProperty("named", named);
  EXPECT_EQ(noticed, kTrials);
  // Sideways only the camera on the other side of the room can tell, and either may be wrong.
  EXPECT_GE(named, kTrials / 2);
}

TEST(ExtensiveDriftWatch, NamesTheCameraThatWasTurned) {
  Random random(23);
  const geometry::Rig rig = paperRigWith(calibratedByWave());
  int named = 0;
  int alone = 0;
  const int kTrials = 24;
  for (int trial = 0; trial < kTrials; ++trial) {
    auto truth = drawTruth(rig, random);
    const std::size_t moved = static_cast<std::size_t>(trial) % 4;
    const Eigen::Vector3d axis(normal(random, 1.0), normal(random, 1.0), 0.0);
    truth[moved] = turned(truth[moved], 0.5 * kDegree * axis.normalized());
    WavedLed scene(truth, 300 + static_cast<std::uint64_t>(trial));
    DriftWatch watch(rig, {});
    scene.runUntil(62.0, [&](const capture::Image& image) { watch.add(image); });
    const auto names = drifted(rig, watch);
    named += names.count(truth[moved].camera.name) == 1;
    alone += names.count(truth[moved].camera.name) == 1 && names.size() == 1;
  }
  RecordProperty("named", named);
  RecordProperty("alone", alone);
  EXPECT_GE(named, kTrials * 9 / 10);
  EXPECT_GE(alone, kTrials * 8 / 10);
}

TEST(ExtensiveDriftWatch, OfFourCamerasNamesTwoThatWereTurnedWithDoubt) {
  Random random(99);
  const geometry::Rig rig = paperRigWith(calibratedByWave());
  for (std::size_t trial = 0; trial < 12; ++trial) {
    auto truth = drawTruth(rig, random);
    for (const std::size_t moved : {trial % 4, (trial + 1 + trial / 4) % 4}) {
      const Eigen::Vector3d axis(normal(random, 1.0), normal(random, 1.0), 0.0);
      truth[moved] = turned(truth[moved], kDegree * axis.normalized());
    }
    WavedLed scene(truth, 800 + trial);
    DriftWatch watch(rig, {});
    scene.runUntil(62.0, [&](const capture::Image& image) { watch.add(image); });
    EXPECT_GE(drifted(rig, watch).size(), 2u) << "trial " << trial;
    for (const auto& drift : watch.drifts())
      EXPECT_TRUE(!drift || drift->ratio < 1.0 || drift->or_others || !drift->or_camera.empty());
  }
}

TEST(ExtensiveDriftWatch, TwoCamerasAreNamedBoth) {
  Random random(24);
  const geometry::Rig rig = paperRigWith(calibratedByWave(), 2);
  auto truth = drawTruth(rig, random);
  truth[1].camera.intrinsics.cy += 3.0;
  WavedLed scene(truth, 400);
  DriftWatch watch(rig, {});
  scene.runUntil(62.0, [&](const capture::Image& image) { watch.add(image); });
  ASSERT_TRUE(watch.drifts()[0]);
  ASSERT_TRUE(watch.drifts()[1]);
  EXPECT_GE(watch.drifts()[0]->ratio, 1.0);
  EXPECT_EQ(watch.drifts()[0]->or_camera, "camera_2");
  EXPECT_EQ(watch.drifts()[1]->or_camera, "camera_1");
  // Of three pixels those across the epipolar line are seen: here nearly all.
  EXPECT_NEAR(watch.drifts()[0]->bias.norm(), 3.0, 0.5);
}

TEST(ExtensiveDriftWatch, OfTwoCamerasUsesTheLatestMinute) {
  Random random(25);
  const geometry::Rig rig = paperRigWith(calibratedByWave(), 2);
  WavedLed scene(drawTruth(rig, random), 401);
  DriftWatch watch(rig, {});
  const auto add = [&](const capture::Image& image) { watch.add(image); };
  scene.runUntil(120.0, add);
  ASSERT_TRUE(watch.drifts()[1]);
  EXPECT_LT(watch.drifts()[1]->ratio, 1.0);
  scene.truth[1].camera.intrinsics.cy += 3.0;
  scene.runUntil(175.0, add);
  ASSERT_TRUE(watch.drifts()[1]);
  EXPECT_GE(watch.drifts()[1]->ratio, 1.0);
}

TEST(ExtensiveDriftWatch, UsesOnlyMotionAndKnownClocks) {
  Random random(25);
  const geometry::Rig rig = paperRigWith(calibratedByWave());
  // A still LED gives the same rounding again and again.
  WavedLed still(rig.cameras, 500);
  still.still = Eigen::Vector3d(1.0, 1.1, 0.9);
  still.pixel = 0.0;
  still.wrong_share = 0.0;
  DriftWatch watch(rig, {});
  still.runUntil(62.0, [&](const capture::Image& image) { watch.add(image); });
  EXPECT_FALSE(watch.drifts()[0]);
  // After a reconnect the time offset is not known: fast motion says nothing, and nothing wrong.
  auto truth = rig.cameras;
  for (geometry::RigCamera& camera : truth)
    camera.time_offset += uniform(random, -0.01, 0.01);
  WavedLed fast(truth, 501);
  fast.epoch = 8;
  DriftWatch unclocked(rig, {});
  fast.runUntil(62.0, [&](const capture::Image& image) { unclocked.add(image); });
  EXPECT_TRUE(drifted(rig, unclocked).empty());
  // The paper's virtual model fits its calibration by intention not.
  geometry::Rig image_center = rig;
  image_center.ray_model = geometry::RayModel::kImageCenter;
  WavedLed scene(rig.cameras, 502);
  DriftWatch paper(image_center, {});
  scene.runUntil(20.0, [&](const capture::Image& image) { EXPECT_FALSE(paper.add(image)); });
}

TEST(ExtensiveDriftWatch, StartsAnewWhenTheClockIsSetBack) {
  Random random(26);
  const geometry::Rig rig = paperRigWith(calibratedByWave());
  DriftWatch watch(rig, {});
  WavedLed scene(rig.cameras, 600);
  scene.runUntil(30.0, [&](const capture::Image& image) { watch.add(image); });
  EXPECT_TRUE(watch.drifts()[0]);
  bool judged = false;
  WavedLed again(rig.cameras, 600);
  again.runUntil(4.0, [&](const capture::Image& image) { judged = watch.add(image) || judged; });
  EXPECT_FALSE(judged);
  EXPECT_FALSE(watch.drifts()[0]);
  again.runUntil(12.0, [&](const capture::Image& image) { judged = watch.add(image) || judged; });
  EXPECT_TRUE(judged);
  EXPECT_TRUE(watch.drifts()[0]);
}

}  // namespace
}  // namespace wiimote_tracker::health
