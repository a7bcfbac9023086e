// Health and continuous calibration while several LEDs are seen.
#include "knock_trial.h"
#include "misled_trial.h"
#include "waved_led.h"

#include "continuous/continuous_calibration.h"
#include "health/health_watch.h"
#include "health/led_selection.h"
#include "health/turned_camera.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace wiimote_tracker::continuous {
namespace {

using health::LedSelection;
using square::Random;

constexpr double kDegrees = M_PI / 180.0;

struct Scene {
  std::size_t leds;
  bool on_body;
};

const std::vector<Scene> kScenes = {{2, false}, {4, false}, {2, true}, {4, true}};

void shine(const Scene& scene, WavedLed* led) {
  led->shine(scene.leds, scene.on_body);
  led->hidden = 0.1;
  led->ghosts = 0.05;
  led->wrong_share = 0.0;
}

/// What a selection made of the images of one camera.
struct Selected {
  int images = 0;
  int spots = 0;
  int right = 0;  // Of the LED that most spots of the last second show.
};

/// The LED whose true pixel is the spot.
std::optional<std::size_t> ledOf(const WavedLed& leds,
                                 const geometry::RigCamera& camera,
                                 double stamp,
                                 const Eigen::Vector2d& spot) {
  const double time = stamp - WavedLed::kClock + camera.time_offset;
  const std::vector<Eigen::Vector3d> places = leds.places(time);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto pixel = camera.camera.project(places[i]);
    if (pixel && (*pixel - spot).norm() < 4.0)
      return i;
  }
  return std::nullopt;
}

/// Sixteen seconds, from four seconds after camera_2 was turned [rad].
std::map<std::string, Selected> select(const Scene& scene, std::uint64_t seed, double turn) {
  Random random(seed);
  const geometry::Rig rig = paperRigWith(wellCalibrated());
  WavedLed leds(drawTruth(rig, random), seed + 100);
  shine(scene, &leds);
  LedSelection selection(rig);
  std::map<std::string, Selected> selected;
  std::optional<std::size_t> followed;
  const auto add = [&](const capture::Image& image) {
    const capture::Image& one = selection.select(image);
    const geometry::RigCamera& camera =
        leds.truth[static_cast<std::size_t>(rig.find(image.camera) - rig.cameras.data())];
    EXPECT_LE(one.spots.size(), image.stamp > WavedLed::kClock + 1.0 ? 1U : 4U);
    Selected& of_camera = selected[image.camera];
    ++of_camera.images;
    if (one.spots.size() != 1)
      return;
    ++of_camera.spots;
    const auto led = ledOf(leds, camera, one.stamp, one.spots.front());
    // The three cameras that stay tell which one is followed.
    if (led && image.camera != "camera_2")
      followed = led;
    of_camera.right += led && led == followed ? 1 : 0;
  };
  leds.runUntil(5.0, add);
  leds.truth[1] = turned(leds.truth[1], turn, random);
  leds.runUntil(9.0, add);
  selected.clear();
  leds.runUntil(25.0, add);
  return selected;
}

TEST(LedSelection, GoesOnWithARigThatDiffersLittle) {
  const geometry::Rig rig = paperRigWith(wellCalibrated());
  const LedSelection selection(rig);
  geometry::Rig other = rig;
  other.cameras[1].masks.push_back({Eigen::Vector2d(100.0, 200.0), 10.0});
  other.cameras[1].camera.world_from_camera.translation().x() += 0.0002;
  EXPECT_TRUE(selection.suits(other));
  other.cameras[1].camera.world_from_camera.translation().x() += 0.02;
  EXPECT_FALSE(selection.suits(other));
  other = rig;
  other.cameras[1].time_offset += 0.004;
  EXPECT_FALSE(selection.suits(other));
  other = rig;
  other.cameras.pop_back();
  EXPECT_FALSE(selection.suits(other));
}

TEST(LedSelection, LeavesTheImagesOfOneLedAlone) {
  WavedLed led(paperRigWith(wellCalibrated()).cameras, 1);
  led.ghosts = 0.05;
  LedSelection selection(paperRigWith(wellCalibrated()));
  led.runUntil(60.0,
               [&](const capture::Image& image) { EXPECT_EQ(&selection.select(image), &image); });
}

TEST(LedSelection, LeavesTheImagesOfARigThatIsNotJudgedAlone) {
  geometry::Rig rig = paperRigWith(wellCalibrated());
  rig.ray_model = geometry::RayModel::kImageCenter;
  WavedLed leds(rig.cameras, 1);
  leds.shine(2, false);
  LedSelection selection(rig);
  leds.runUntil(5.0,
                [&](const capture::Image& image) { EXPECT_EQ(&selection.select(image), &image); });
}

// A second LED shines from 3 s on. One camera sees only the first until just after the selection
// has noticed, then only the second.
TEST(LedSelection, DoesNotJoinTheSpotsOfTwoLeds) {
  const geometry::Rig rig = paperRigWith(wellCalibrated());
  int changes = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    WavedLed leds(rig.cameras, seed, 100.0);
    leds.wrong_share = 0.0;
    LedSelection selection(rig);
    std::map<std::string, std::pair<double, std::size_t>> last;  // Stamp [s] and LED, by camera.
    const auto add = [&](capture::Image image) {
      const geometry::RigCamera& camera = *rig.find(image.camera);
      const std::size_t hidden = image.stamp < WavedLed::kClock + 3.11 ? 1 : 0;
      const auto isHidden = [&](const Eigen::Vector2d& spot) {
        return ledOf(leds, camera, image.stamp, spot) == hidden;
      };
      if (image.camera == "camera_4")
        image.spots.erase(std::remove_if(image.spots.begin(), image.spots.end(), isHidden),
                          image.spots.end());
      const capture::Image& one = selection.select(image);
      if (one.spots.size() != 1)
        return;
      const auto led = ledOf(leds, camera, one.stamp, one.spots.front());
      if (!led)
        return;
      const auto before = last.find(image.camera);
      if (before != last.end() && before->second.second != *led) {
        ++changes;
        EXPECT_GT(image.stamp - before->second.first, capture::kLongestGap) << seed;
      }
      last[image.camera] = {image.stamp, *led};
    };
    leds.runUntil(3.0, add);
    leds.shine(2, false);
    leds.runUntil(6.0, add);
  }
  EXPECT_GT(changes, 0);
}

TEST(LedSelection, FollowsOneLedInAllCamerasAlsoInATurnedOne) {
  for (const double turn : {0.0, 0.5, 2.0, 4.0}) {
    for (const Scene& scene : kScenes) {
      for (std::uint64_t seed = 1; seed <= 2; ++seed) {
        for (const auto& [name, selected] : select(scene, seed, turn * kDegrees)) {
          SCOPED_TRACE(name + ", " + std::to_string(scene.leds) +
                       (scene.on_body ? " of a body, " : " persons, ") + std::to_string(turn));
          EXPECT_GT(selected.spots, (scene.on_body ? 0.3 : 0.6) * selected.images);
          EXPECT_GE(selected.right, 0.97 * selected.spots);
        }
      }
    }
  }
}

TEST(LedSelection, LeavesALedThatRests) {
  const geometry::Rig rig = paperRigWith(wellCalibrated());
  WavedLed leds(rig.cameras, 3);
  leds.shine(2, false);
  leds.path.pace = 0.0;
  leds.wrong_share = 0.0;
  LedSelection selection(rig);
  int resting = 0;
  int moving = 0;
  leds.runUntil(20.0, [&](const capture::Image& image) {
    const capture::Image& one = selection.select(image);
    if (one.spots.size() != 1)
      return;
    const auto led = ledOf(leds, *rig.find(image.camera), one.stamp, one.spots.front());
    resting += led == 0U ? 1 : 0;
    moving += led == 1U ? 1 : 0;
  });
  EXPECT_LT(resting, 200);
  EXPECT_GT(moving, 2500);
}

// With the barrel lens the third LED, near the edge, is out of view after the turn. Another light
// shines where it was.
TEST(TurnedCamera, MatchesTheSpotsWithTheTurnThatItFound) {
  geometry::Rig rig = paperRigWith(wellCalibrated());
  geometry::Camera& calibrated = rig.cameras[0].camera;
  calibrated.world_from_camera.setIdentity();
  calibrated.intrinsics.distortion[0] = -1.0;
  geometry::Camera truth = calibrated;
  truth.world_from_camera.rotate(Eigen::AngleAxisd(0.03, Eigen::Vector3d::UnitY()));
  const Eigen::Vector3d outermost(-1.12, 0.0, 2.0);
  ASSERT_FALSE(truth.project(outermost));
  health::TurnedCamera camera(rig, rig.cameras[0]);
  for (double time = 0.0; time < 5.0; time += 0.05) {
    const std::vector<Eigen::Vector3d> leds = {
        {0.4 * std::sin(2.0 * time), 0.2, 2.0}, {0.1, 0.3 * std::cos(3.0 * time), 2.0}, outermost};
    const capture::Blobs spots = {truth.project(leds[0]).value(), truth.project(leds[1]).value(),
                                  calibrated.project(outermost).value()};
    const health::LedMatches matches = camera.add(time, leds, spots);
    for (std::size_t i = 0; i < leds.size(); ++i) {
      if (!matches.spot_of[i])
        continue;
      const auto pixel = camera.project(leds[i]);
      ASSERT_TRUE(pixel) << time;
      EXPECT_LT((*pixel - spots[*matches.spot_of[i]]).norm(), 15.0) << time;
    }
  }
  EXPECT_TRUE(camera.isTurned());
}

// As from another computer over a slow network.
TEST(LedSelection, KeepsTheLedInImagesThatComeLate) {
  constexpr double kLate = 0.12;  // [s]
  const geometry::Rig rig = paperRigWith(wellCalibrated());
  WavedLed leds(rig.cameras, 5);
  shine({2, false}, &leds);
  LedSelection selection(rig);
  std::deque<capture::Image> under_way;
  std::vector<std::pair<double, std::size_t>> followed;  // Stamp [s], and LED of the others.
  int images = 0;
  int spots = 0;
  int right = 0;
  const auto takeLate = [&](const capture::Image& image) {
    const capture::Image& one = selection.select(image);
    ++images;
    if (one.spots.size() != 1)
      return;
    ++spots;
    const auto then = std::find_if(followed.rbegin(), followed.rend(),
                                   [&](const auto& each) { return each.first < image.stamp; });
    const auto led = ledOf(leds, *rig.find(image.camera), one.stamp, one.spots.front());
    right += led && then != followed.rend() && led == then->second ? 1 : 0;
  };
  leds.runUntil(40.0, [&](const capture::Image& image) {
    while (!under_way.empty() && under_way.front().stamp < image.stamp - kLate) {
      takeLate(under_way.front());
      under_way.pop_front();
    }
    if (image.camera == "camera_3") {
      under_way.push_back(image);
      return;
    }
    const capture::Image& one = selection.select(image);
    const auto led = one.spots.size() == 1
                         ? ledOf(leds, *rig.find(image.camera), one.stamp, one.spots.front())
                         : std::nullopt;
    if (led)
      followed.emplace_back(image.stamp, *led);
  });
  EXPECT_GT(spots, 0.6 * images);
  EXPECT_GE(right, 0.97 * spots);
}

TEST(LedSelection, IsAFunctionOfTheImages) {
  const auto spots = [] {
    std::vector<double> all;
    const geometry::Rig rig = paperRigWith(wellCalibrated());
    WavedLed leds(rig.cameras, 4);
    shine({4, false}, &leds);
    LedSelection selection(rig);
    leds.runUntil(10.0, [&](const capture::Image& image) {
      for (const Eigen::Vector2d& spot : selection.select(image).spots)
        all.push_back(spot.x());
    });
    return all;
  };
  EXPECT_EQ(spots(), spots());
}

TEST(ExtensiveLedSelection, NamesTheCameraThatWasTurned) {
  for (const Scene& scene : kScenes) {
    for (std::size_t index = 0; index < 4; ++index) {
      Random random(20 + index);
      const geometry::Rig rig = paperRigWith(calibratedByWave());
      WavedLed leds(drawTruth(rig, random), 200 + index);
      shine(scene, &leds);
      // About an axis across the view: a roll leaves the median.
      leds.truth[index].camera.world_from_camera.rotate(
          Eigen::AngleAxisd(0.5 * kDegrees, Eigen::Vector3d(0.6, 0.8, 0.0)));
      LedSelection selection(rig);
      health::HealthWatch watch(rig, {});
      leds.runUntil(62.0,
                    [&](const capture::Image& image) { watch.addImage(selection.select(image)); });
      for (const auto& [name, health] : watch.healths()) {
        SCOPED_TRACE(std::to_string(scene.leds) + (scene.on_body ? " of a body" : " persons"));
        EXPECT_EQ(health.text.empty(), name != rig.cameras[index].camera.name)
            << name << ' ' << health.text;
      }
    }
  }
}

TEST(ExtensiveLedSelection, AKnockedCameraIsBroughtBack) {
  for (const std::size_t leds : {2, 4}) {
    for (const double turn : {1.0, 2.0, 3.0}) {
      for (const std::uint64_t seed : {0, 1, 3}) {
        Knock knock;
        knock.turn = turn * kDegrees;
        knock.leds = leds;
        const KnockTrial trial = runKnockTrial(knock, seed);
        EXPECT_TRUE(trial.found && !trial.others) << leds << ' ' << turn << ' ' << seed;
        EXPECT_LT(trial.seconds, 30.0);
        EXPECT_LT(trial.error, 0.006);
      }
    }
  }
}

// Of LEDs that hide each other, three cameras see the same one clearly a fifth of the time.
TEST(ExtensiveLedSelection, AKnockedCameraIsBroughtBackByABody) {
  for (const std::size_t leds : {3, 4}) {
    for (const double turn : {1.0, 2.0, 3.0}) {
      for (const std::uint64_t seed : {0, 1}) {
        Knock knock;
        knock.turn = turn * kDegrees;
        knock.leds = leds;
        knock.on_body = true;
        const KnockTrial trial = runKnockTrial(knock, seed);
        EXPECT_TRUE(trial.found && !trial.others) << leds << ' ' << turn << ' ' << seed;
        EXPECT_LT(trial.error, 0.006);
      }
    }
  }
}

TEST(ExtensiveLedSelection, ANewClockIsSolved) {
  for (const Scene& scene : {Scene{2, false}, Scene{4, false}}) {
    const geometry::Rig rig = paperRigWith(wellCalibrated());
    WavedLed leds(rig.cameras, 800);
    shine(scene, &leds);
    leds.truth[1].time_offset = -0.015;
    LedSelection selection(rig);
    ContinuousCalibration watch(rig, {});
    std::optional<Proposal> proposal;
    leds.runUntil(60.0, [&](capture::Image image) {
      if (image.camera == leds.truth[1].camera.name)
        image.clock_epoch = 8;
      if (!proposal)
        proposal = watch.add(selection.select(image));
    });
    ASSERT_TRUE(proposal) << scene.leds;
    EXPECT_EQ(proposal->cause, Cause::kReconnect);
    EXPECT_NEAR(proposal->rig.cameras[1].time_offset, -0.015, 0.0005);
    EXPECT_EQ(proposal->rig.solved_at, rig.solved_at);
  }
}

TEST(ExtensiveLedSelection, OtherLightsNeverMakeTheRigAMillimetreWorse) {
  for (const Misled by : {Misled::kMirror, Misled::kOtherLed, Misled::kCarried, Misled::kLamp,
                          Misled::kMasked, Misled::kTwoLights}) {
    for (const Scene& scene : kScenes) {
      for (std::uint64_t seed = 1; seed <= 2; ++seed)
        EXPECT_LT(runMisledTrial(by, seed, scene.leds, scene.on_body).worse, 0.001)
            << static_cast<int>(by) << ' ' << scene.leds << ' ' << scene.on_body << ' ' << seed;
    }
  }
}

}  // namespace
}  // namespace wiimote_tracker::continuous
