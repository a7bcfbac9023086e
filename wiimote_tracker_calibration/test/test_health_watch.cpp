// What is found of cameras: when it begins and ends, its words, and what to do.
#include "expect_says.h"
#include "waved_led.h"

#include "health/alarm.h"
#include "health/health_watch.h"
#include "health/remedy.h"

#include <gtest/gtest.h>

#include <cmath>
#include <deque>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace wiimote_tracker::health {
namespace {

using square::Random;

constexpr double kOneDegree = M_PI / 180.0;

TEST(Alarm, DoesNotFlap) {
  Alarm alarm;
  int changes = 0;
  bool on = false;
  const auto judge = [&](double ratio) {
    alarm.judge(ratio);
    changes += alarm.on() != on;
    on = alarm.on();
  };
  // What wavers about the limit begins once.
  for (int i = 0; i < 50; ++i)
    judge(i % 3 == 0 ? 0.9 : 1.1);
  EXPECT_TRUE(on);
  EXPECT_EQ(changes, 1);
  // Single judgements that all is well are not believed, two are.
  judge(0.1);
  EXPECT_TRUE(on);
  judge(0.9);
  judge(0.1);
  EXPECT_TRUE(on);
  judge(0.1);
  EXPECT_FALSE(on);
  judge(1.5);
  EXPECT_FALSE(on);
}

TEST(HealthWatch, NoticesAnotherDevice) {
  Random random(32);
  const geometry::Rig rig = paperRigWith(calibratedByWave());
  HealthWatch watch(rig, {});
  capture::Image image;
  image.camera = "camera_2";
  const auto addFrom = [&](const char* device) {
    image.identity = device;
    watch.addImage(image);
  };
  addFrom("");
  EXPECT_TRUE(watch.takeNews().empty());
  addFrom("00:1e:35:ff:ff:ff");
  addFrom("00:1e:35:ff:ff:ff");
  const auto isSilent = [](const auto&) { return true; };
  EXPECT_TRUE(watch.takeNews(isSilent).empty());
  const auto news = watch.takeNews();
  ASSERT_EQ(news.size(), 1u) << "what was not said stays news";
  EXPECT_EQ(news.front(), "camera_2");
  EXPECT_TRUE(watch.takeNews().empty());
  EXPECT_SAYS(watch.healths().at("camera_2").text, "is another device (00:1e:35:ff:ff:ff)");
  addFrom("00:1e:35:00:00:02");
  EXPECT_EQ(watch.healths().at("camera_2").text, "");
  // One that is well again does not stay so.
  addFrom("00:1e:35:ff:ff:ff");
  EXPECT_TRUE(watch.takeNews(isSilent).empty());
  addFrom("00:1e:35:00:00:02");
  EXPECT_EQ(watch.takeNews(isSilent).size(), 1u);
  EXPECT_TRUE(watch.takeNews().empty());
  // Cameras that are not in the rig are nobody's concern.
  image.camera = "elsewhere";
  addFrom("x");
  watch.addAcceleration("elsewhere", 0.0, {0.0, 0.0, 9.81});
  EXPECT_EQ(watch.healths().size(), 4u);
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

TEST(HealthWatch, SaysWhichCamerasWaitForAMovingLed) {
  Random random(33);
  const geometry::Rig rig = paperRigWith(calibratedByWave());
  HealthWatch watch(rig, {});
  const std::string reason = "no LED has moved lately where it and others see it";
  EXPECT_EQ(watch.notJudged()[reason].size(), rig.cameras.size());
  WavedLed scene(drawTruth(rig, random), 701);
  track(&scene, 0.0, 30.0, &watch, &random);
  EXPECT_TRUE(watch.notJudged().empty());
  capture::Image image;
  image.spots = {{512.0, 384.0}};  // It rests for longer than the window.
  for (double time = 30.0; time < 100.0; time += 0.02) {
    image.stamp = WavedLed::kClock + time;
    for (const geometry::RigCamera& camera : rig.cameras) {
      image.camera = camera.camera.name;
      watch.addImage(image);
    }
  }
  EXPECT_EQ(watch.notJudged()[reason].size(), rig.cameras.size());
  EXPECT_TRUE(watch.healths().at("camera_1").drift) << "the last judgement stays";
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
  scene.truth[2] = turned(before, Eigen::Vector3d(3.0 * kOneDegree, 0.0, 0.0));
  track(&scene, 90.0, 180.0, &watch, &random);
  const std::vector<std::string> news = watch.takeNews();
  ASSERT_EQ(news.size(), 1u) << (news.empty() ? "" : news.back());
  EXPECT_EQ(news.front(), "camera_3");
  EXPECT_SAYS(watch.healths().at("camera_3").advice, "recalibrate");
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
    EXPECT_EQ(addCamera(other, "wiimote_5"), "calibrate all cameras again, with a waved LED");
  }
  rig.cameras.resize(2);
  rig.covariance.resize(0, 0);
  EXPECT_EQ(addCamera(rig, "wiimote_5"), "add it (r wiimote_5 in calibrate)");
  rig.cameras[0].camera.identity = "00:1e:35:00:00:01";
  HealthWatch watch(rig, {});
  watch.addImage({rig.cameras[0].camera.name, 0.0, 0, {}, {}, "00:1e:35:ff:ff:ff"});
  EXPECT_EQ(watch.healths().at(rig.cameras[0].camera.name).advice, "calibrate all cameras again");
}

TEST(HealthWatch, FindingsStayWhenTheRigIsAdjustedAndEndWhenItIsSolvedAnew) {
  Random random(33);
  geometry::Rig rig = paperRigWith(calibratedByWave());
  rig.solved_at = WavedLed::kClock;
  HealthWatch watch(rig, {});
  WavedLed scene(drawTruth(rig, random), 701);
  scene.truth[2] = turned(scene.truth[2], Eigen::Vector3d(3.0 * kOneDegree, 0.0, 0.0));
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
  rig.cameras[1] = turned(rig.cameras[1], Eigen::Vector3d(3.0 * kOneDegree, 0.0, 0.0));
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

geometry::Rig rigWithoutAccelerometers() {
  geometry::Rig rig = paperRigWith(calibratedByWave());
  for (geometry::RigCamera& camera : rig.cameras)
    camera.gravity.reset();
  return rig;
}

TEST(HealthWatch, AFindingOfDriftEndsWhenTheCameraIsSolvedThere) {
  Random random(34);
  geometry::Rig rig = rigWithoutAccelerometers();
  HealthWatch watch(rig, {});
  WavedLed scene(drawTruth(rig, random), 702);
  const Eigen::Vector3d turn(0.05 * kOneDegree, 0.0, 0.0);
  scene.truth[2] = turned(scene.truth[2], turn);
  track(&scene, 0.0, 90.0, &watch, &random);
  EXPECT_SAYS(watch.healths().at("camera_3").text, "drifted");
  rig.cameras[2] = turned(rig.cameras[2], turn);
  EXPECT_TRUE(watch.follow(rig));
  EXPECT_EQ(watch.healths().at("camera_3").text, "");
}

TEST(HealthWatch, CamerasThatMayNotHaveMovedAreWellOnceTheOthersAreSolved) {
  Random random(36);
  geometry::Rig rig = rigWithoutAccelerometers();
  HealthWatch watch(rig, {});
  WavedLed scene(drawTruth(rig, random), 704);
  const Eigen::Vector3d turn(2.0 * kOneDegree, 0.0, 0.0);
  for (const std::size_t i : {1, 2})
    scene.truth[i] = turned(scene.truth[i], turn);
  track(&scene, 0.0, 90.0, &watch, &random);
  int doubtful = 0;
  for (const auto& [name, health] : watch.healths())
    doubtful += health.or_others && !health.text.empty();
  EXPECT_GT(doubtful, 0);
  for (const std::size_t i : {1, 2})
    rig.cameras[i] = turned(rig.cameras[i], turn);
  EXPECT_TRUE(watch.follow(rig));
  for (const auto& [name, health] : watch.healths())
    EXPECT_EQ(health.text, "") << name;
}

/// Health after a minute in which the images of camera_3 came so much later [s].
std::map<std::string, CameraHealth> healthsWithLateImages(double late, WavedLed* led) {
  HealthWatch watch(paperRigWith(calibratedByWave()), {});
  std::deque<capture::Image> under_way;
  led->runUntil(62.0, [&](const capture::Image& image) {
    while (!under_way.empty() && under_way.front().stamp < image.stamp - late) {
      watch.addImage(under_way.front());
      under_way.pop_front();
    }
    if (image.camera == "camera_3")
      under_way.push_back(image);
    else
      watch.addImage(image);
  });
  return watch.healths();
}

TEST(HealthWatch, SaysWhyACameraIsNotJudged) {
  const std::vector<geometry::RigCamera> cameras = paperRigWith(calibratedByWave()).cameras;
  WavedLed led(cameras, 1);
  for (const auto& [name, health] : healthsWithLateImages(0.3, &led)) {
    EXPECT_EQ(health.drift.has_value(), name != "camera_3") << name;
    EXPECT_SAYS(health.no_drift, name == "camera_3" ? "images of camera_3 come 0.3" : "");
  }
  WavedLed of_another_clock(cameras, 2);
  for (const auto& [name, health] : healthsWithLateImages(3.0, &of_another_clock))
    EXPECT_SAYS(health.no_drift, "images of camera_3 come 3.0");
  HealthWatch watch(paperRigWith(calibratedByWave()), {});
  WavedLed of_a_clock_ahead(cameras, 2);
  of_a_clock_ahead.runUntil(62.0, [&](capture::Image image) {
    image.stamp += image.camera == "camera_3" ? 3.0 : 0.0;
    watch.addImage(image);
  });
  for (const auto& [name, health] : watch.healths())
    EXPECT_SAYS(health.no_drift, "later than those of camera_3");
  WavedLed resting(cameras, 3);
  resting.still = Eigen::Vector3d(1.0, 1.1, 0.9);
  resting.wrong_share = 0.0;
  for (const auto& [name, health] : healthsWithLateImages(0.0, &resting))
    EXPECT_EQ(health.no_drift, "no LED has moved lately where it and others see it") << name;
}

TEST(HealthWatch, NamesTwoRemotesThatWereExchanged) {
  Random random(35);
  const geometry::Rig rig = paperRigWith(calibratedByWave());
  HealthWatch watch(rig, {});
  WavedLed scene(drawTruth(rig, random), 703);
  std::swap(scene.truth[0].camera.world_from_camera, scene.truth[1].camera.world_from_camera);
  // Nobody puts a remote exactly where the other one was.
  for (const std::size_t i : {0, 1}) {
    scene.truth[i] = turned(scene.truth[i], 2.0 * kOneDegree, random);
    scene.truth[i].camera.world_from_camera.translation() += 0.02 * square::anyDirection(random);
  }
  track(&scene, 0.0, 90.0, &watch, &random);
  for (const auto& [name, health] : watch.healths()) {
    const bool is_first = name == "camera_1";
    if (!is_first && name != "camera_2") {
      EXPECT_EQ(health.text, "") << name;
      continue;
    }
    EXPECT_EQ(health.text, "seems exchanged with " +
                               std::string(is_first ? "camera_2" : "camera_1") +
                               ": each sees what the other one should");
    EXPECT_EQ(health.advice, "put each where the other one is now, or calibrate all cameras again");
  }
  EXPECT_EQ(watch.takeNews().size(), 2u);
}

TEST(HealthWatch, NamesTwoDriversThatHaveEachOthersRemotes) {
  const geometry::Rig rig = paperRigWith(calibratedByWave());
  HealthWatch watch(rig, {});
  watch.addImage({"camera_1", 0.0, 7, {}, {}, "00:1e:35:00:00:03"});
  watch.addImage({"camera_3", 0.0, 7, {}, {}, "00:1e:35:00:00:01"});
  EXPECT_EQ(watch.healths().at("camera_1").text,
            "is the device (00:1e:35:00:00:03) that was calibrated as camera_3");
  for (const char* const name : {"camera_1", "camera_3"})
    EXPECT_EQ(watch.healths().at(name).advice,
              "give the driver of each camera the address that was calibrated");
}

}  // namespace
}  // namespace wiimote_tracker::health
