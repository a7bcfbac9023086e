// Whether cameras that were moved are noticed, and only these: over many simulated minutes.

#include "expect_says.h"
#include "waved_led.h"

#include "health/drift_watch.h"
#include "health/health_watch.h"
#include "health/remedy.h"
#include "health/tilt_watch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
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

/// A camera that is turned about its own axes [rad].
geometry::RigCamera turned(geometry::RigCamera camera, const Eigen::Vector3d& rotation) {
  camera.camera.world_from_camera.rotate(geometry::so3::exp(rotation));
  return camera;
}

/// What an accelerometer reads that counts in steps.
Eigen::Vector3d reading(const Eigen::Vector3d& force, double noise, double step, Random& random) {
  Eigen::Vector3d value = force;
  for (Eigen::Index i = 0; i < 3; ++i)
    value[i] = step * std::round((value[i] + normal(random, noise)) / step);
  return value;
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

/// Feeds a watch with images and readings for a while.
void track(WavedLed* scene, double from, double until, HealthWatch* watch, Random* random) {
  const std::vector<geometry::RigCamera>& truth = scene->truth;
  double next = from;
  scene->runUntil(until, [&](capture::Image image) {
    for (const geometry::RigCamera& camera : truth) {
      if (camera.camera.name == image.camera)
        image.identity = camera.camera.identity;
    }
    watch->addImage(image);
    for (; next < image.stamp - WavedLed::kClock; next += 0.05) {
      for (const geometry::RigCamera& camera : truth) {
        const Eigen::Vector3d up = camera.camera.world_from_camera.linear().row(2);
        watch->addAcceleration(camera.camera.name, next, reading(9.81 * up, 0.03, 0.18, *random));
      }
    }
  });
}

TEST(HealthWatch, NamesABumpedCameraOnceAndSaysWhatToDo) {
  Random random(31);
  const geometry::Rig rig = paperRigWith(calibratedByWave());
  HealthWatch watch(rig, {});
  WavedLed scene(drawTruth(rig, random), 700);
  track(&scene, 0.0, 90.0, &watch, &random);
  EXPECT_TRUE(watch.takeNews().empty());
  for (const auto& camera : watch.healths()) {
    EXPECT_EQ(camera.second.text, "");
    EXPECT_TRUE(camera.second.tilt) << camera.first;
    EXPECT_TRUE(camera.second.drift) << camera.first;
  }

  const geometry::RigCamera before = scene.truth[2];
  scene.truth[2] = turned(before, Eigen::Vector3d(3.0 * kDegree, 0.0, 0.0));
  track(&scene, 90.0, 180.0, &watch, &random);
  const std::vector<std::string> news = watch.takeNews();
  ASSERT_EQ(news.size(), 1u) << (news.empty() ? "" : news.back());
  EXPECT_SAYS(news.front(), "camera_3 ");
  EXPECT_SAYS(news.front(), "recalibrate");
  const std::string text = watch.healths().at("camera_3").text;
  EXPECT_SAYS(text, "tilted by");
  EXPECT_SAYS(text, "; drifted");
  EXPECT_EQ(watch.healths().at("camera_3").advice,
            "put it back, or recalibrate it (r in calibrate)");
  EXPECT_EQ(watch.healths().at("camera_1").text, "");

  scene.truth[2] = before;
  int named = 0;
  for (double time = 180.0; time < 300.0; time += 2.0) {
    track(&scene, time, time + 2.0, &watch, &random);
    const std::string now = watch.healths().at("camera_3").text;
    const std::size_t found = now.find(" px (+-");
    if (found != std::string::npos) {
      const std::size_t number = now.rfind(' ', found - 1);
      EXPECT_GE(std::stod(now.substr(number)), DriftOptions().limit) << now;
      ++named;
    }
  }
  EXPECT_GT(named, 0);
  EXPECT_EQ(watch.healths().at("camera_3").text, "");
}

TEST(HealthWatch, OffersToRecalibrateOnlyWhereThatCanWork) {
  geometry::Rig rig = paperRigWith(calibratedByWave());
  EXPECT_EQ(putBack(rig, true), "put it back, or recalibrate it (r in calibrate)");
  EXPECT_EQ(putBack(rig, false),
            "see which was moved, put it back, or recalibrate it (r in calibrate)");
  geometry::Rig of_centers = rig;
  of_centers.ray_model = geometry::RayModel::kImageCenter;
  geometry::Rig of_square = rig;
  of_square.cameras[3].time_offset_rule = geometry::TimeOffsetRule::kNone;
  for (const geometry::Rig& other : {of_centers, of_square}) {
    EXPECT_EQ(putBack(other, true), "put it back, or calibrate all cameras again");
    EXPECT_EQ(addCamera(other, "wiimote_5"), "calibrate all cameras again");
  }
  rig.cameras.resize(2);
  rig.covariance.resize(0, 0);
  EXPECT_EQ(addCamera(rig, "wiimote_5"), "add it (r wiimote_5 in calibrate)");
  rig.cameras[0].camera.identity = "00:1e:35:00:00:01";
  HealthWatch watch(rig, {});
  watch.addImage({rig.cameras[0].camera.name, 0.0, 0, {}, {}, "00:1e:35:00:00:02"});
  EXPECT_EQ(watch.healths().at(rig.cameras[0].camera.name).advice, "calibrate all cameras again");
}

TEST(HealthWatch, FindingsStayWhenTheRigIsAdjustedAndEndWhenItIsSolvedAnew) {
  Random random(33);
  geometry::Rig rig = paperRigWith(calibratedByWave());
  rig.solved_at = WavedLed::kClock;
  HealthWatch watch(rig, {});
  WavedLed scene(drawTruth(rig, random), 701);
  scene.truth[2] = turned(scene.truth[2], Eigen::Vector3d(3.0 * kDegree, 0.0, 0.0));
  track(&scene, 0.0, 90.0, &watch, &random);
  ASSERT_EQ(watch.takeNews().size(), 1u);
  const std::string text = watch.healths().at("camera_3").text;

  rig.cameras[0].camera.world_from_camera.translation().x() += 0.0002;
  EXPECT_TRUE(watch.follow(rig));
  EXPECT_EQ(watch.healths().at("camera_3").text, text);
  track(&scene, 90.0, 120.0, &watch, &random);
  EXPECT_TRUE(watch.takeNews().empty());
  EXPECT_SAYS(watch.healths().at("camera_3").text, "tilted by");

  // Another camera was solved.
  rig.solved_at += 100.0;
  rig.cameras[1] = turned(rig.cameras[1], Eigen::Vector3d(3.0 * kDegree, 0.0, 0.0));
  EXPECT_TRUE(watch.follow(rig));
  EXPECT_SAYS(watch.healths().at("camera_3").text, "tilted by");
  track(&scene, 120.0, 123.0, &watch, &random);
  EXPECT_TRUE(watch.takeNews().empty());

  geometry::Rig anew = rig;
  anew.cameras[2].gravity->x() += 0.1;
  EXPECT_TRUE(watch.follow(anew));
  EXPECT_EQ(watch.healths().at("camera_3").text, "");
  anew.cameras[2].camera.name = "another";
  EXPECT_FALSE(watch.follow(anew));
}

TEST(HealthWatch, AFindingOfDriftEndsWhenTheCameraIsSolvedThere) {
  Random random(34);
  geometry::Rig rig = paperRigWith(calibratedByWave());
  for (geometry::RigCamera& camera : rig.cameras)
    camera.gravity.reset();
  HealthWatch watch(rig, {});
  WavedLed scene(drawTruth(rig, random), 702);
  const Eigen::Vector3d turn(0.05 * kDegree, 0.0, 0.0);
  scene.truth[2] = turned(scene.truth[2], turn);
  track(&scene, 0.0, 90.0, &watch, &random);
  EXPECT_SAYS(watch.healths().at("camera_3").text, "drifted");
  rig.cameras[2] = turned(rig.cameras[2], turn);
  EXPECT_TRUE(watch.follow(rig));
  EXPECT_EQ(watch.healths().at("camera_3").text, "");
}

}  // namespace
}  // namespace wiimote_tracker::health
