// A camera that is turned while LEDs are tracked.
#include "tracking/tracker_runs.h"

#include "wiimote_tracker_triangulation/geometry/camera_parameters.h"
#include "wiimote_tracker_triangulation/geometry/so3.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker::tracking::test {
namespace {

constexpr std::size_t kKnocked = 1;
constexpr double kKnock = 4.0;  // since the start [s]
constexpr double kBack = 8.0;   // turned back [s]
constexpr double kEnd = 11.0;   // [s]
constexpr double kTurn = 0.25;  // moves spots by 6 px, out of their gates [degrees]

struct Knock {
  std::optional<double> out;   // after the knock the camera is a misfit [s]
  std::optional<double> used;  // after it is turned back it is none [s]
  bool inaccurate = false;     // while it is turned, its calibration is called so
  std::size_t alarms = 0;      // snapshots in which another camera is one, or this before
  std::size_t leds = 0;        // in snapshots while the camera is turned, and after
  std::size_t tracked = 0;
  double worst = 0.0;  // distance of a tracked point from the nearest LED while turned [m]
};

bool has(const Tracker& tracker, std::size_t camera, CameraFault::Kind kind) {
  const auto fault = tracker.cameraFault(camera);
  return fault && fault->kind == kind;
}

bool isMisfit(const Tracker& tracker, std::size_t camera) {
  return has(tracker, camera, CameraFault::Kind::kMisfit);
}

double distanceToNearest(const std::vector<Path>& leds, const TrackedLed& led, double time) {
  double least = std::numeric_limits<double>::infinity();
  for (const Path& path : leds)
    least = std::min(least, (path(time) - led.position).norm());
  return least;
}

/// Turns a camera and back. @param direction in its image plane, about which it turns [rad]
/// @param loaded replaces the rig at the start
Knock knock(const geometry::Rig& rig,
            const std::vector<Path>& leds,
            double degrees,
            double direction,
            unsigned seed,
            const std::optional<geometry::Rig>& loaded = std::nullopt) {
  geometry::Rig turned = rig;
  const Eigen::Vector3d axis(std::cos(direction), std::sin(direction), 0.0);
  turned.cameras[kKnocked].camera.world_from_camera.rotate(
      Eigen::AngleAxisd(degrees * M_PI / 180.0, axis));
  SceneOptions options;
  options.dropout = 0.02;
  options.ghosts = 0.1;
  options.merging_distance = 8.0;
  Scene before(rig, leds, options, seed);
  Scene during(turned, leds, options, seed);  // exposes at the same times
  Tracker tracker(rig, exactOptions());
  if (loaded)
    tracker.setRig(*loaded);
  Knock result;
  for (double time = 0.0; time < kEnd;) {
    const SceneImage& right = before.next();
    const SceneImage& wrong = during.next();
    time = right.true_time - options.start;
    const bool is_turned = time >= kKnock && time < kBack;
    tracker.add(right.camera, is_turned ? wrong.image : right.image);
    const bool is_misfit = isMisfit(tracker, kKnocked);
    result.inaccurate |= is_turned && has(tracker, kKnocked, CameraFault::Kind::kInaccurate);
    if (is_turned && is_misfit && !result.out)
      result.out = time - kKnock;
    if (time >= kBack && !is_misfit && !result.used)
      result.used = time - kBack;
    for (std::size_t camera = 0; camera < rig.cameras.size(); ++camera)
      result.alarms += (camera != kKnocked || time < kKnock) && isMisfit(tracker, camera);
    while (const Snapshot* snapshot = tracker.next()) {
      if (time < kKnock)
        continue;
      result.leds += leds.size();
      for (const TrackedLed& led : snapshot->leds) {
        if (led.state != TrackState::kTracked)
          continue;
        ++result.tracked;
        if (is_turned)
          result.worst = std::max(result.worst, distanceToNearest(leds, led, snapshot->time));
      }
    }
  }
  return result;
}

geometry::Rig firstOfPaperRig(std::size_t cameras) {
  geometry::Rig rig = paperRig();
  rig.cameras.resize(cameras);
  return rig;
}

/// States errors of several pixels, as one from a square alone.
geometry::Rig vagueRig() {
  geometry::Rig rig = paperRig();
  rig.covariance.setZero(4 * geometry::kParameters, 4 * geometry::kParameters);
  for (std::size_t camera = 0; camera < 4; ++camera)
    rig.covariance.diagonal().segment<3>(geometry::firstParameter(camera)).fill(3e-3 * 3e-3);
  return rig;
}

std::vector<Path> oneWanderer(unsigned seed) {
  geometry::test::Random random(seed);
  return {wandering(random, {1.25, 1.25, 1.0}, 0.6, 1.0)};
}

TEST(TrackerKnocks, AKnockedCameraIsLeftOutWithinASecondAndTheOthersGoOn) {
  for (const std::size_t cameras : {3u, 4u}) {
    for (const double degrees : {1.0, 2.0, 3.0}) {
      for (const std::vector<Path>& leds :
           {oneWanderer(1), wanderers(4, 1), {still({1.0, 1.4, 1.2})}}) {
        const std::string what = std::to_string(cameras) + " cameras, " +
                                 std::to_string(leds.size()) + " LEDs, " + std::to_string(degrees);
        const Knock result = knock(firstOfPaperRig(cameras), leds, degrees, degrees, 2);
        ASSERT_TRUE(result.out && result.used) << what;
        EXPECT_LE(*result.out, 1.0) << what;
        EXPECT_LE(*result.used, 1.0) << what;
        EXPECT_EQ(0u, result.alarms) << what;
        EXPECT_GE(result.tracked, 0.999 * result.leds) << what;
        EXPECT_LT(result.worst, 0.025) << what;
      }
    }
  }
}

TEST(TrackerKnocks, ATurnThatErrorsOfTheCalibrationExplainIsNotNamedOne) {
  const geometry::Rig vague = vagueRig();
  EXPECT_TRUE(knock(paperRig(), oneWanderer(1), kTurn, 0.5, 2).out);
  const Knock result = knock(vague, oneWanderer(1), kTurn, 0.5, 2);
  EXPECT_FALSE(result.out);
  EXPECT_TRUE(result.inaccurate);
  EXPECT_EQ(0u, result.alarms);
  EXPECT_GT(result.leds, 2000u);
  EXPECT_GE(result.tracked, 0.999 * result.leds);
  const auto out = knock(vague, oneWanderer(1), 1.0, 0.5, 2).out;
  ASSERT_TRUE(out);
  EXPECT_LE(*out, 1.0);
}

TEST(TrackerKnocks, ErrorsThatAreStatedLaterExplainATurnToo) {
  const geometry::Rig vague = vagueRig();
  ASSERT_EQ(paperRig().id(), vague.id());
  const Knock result = knock(paperRig(), oneWanderer(1), kTurn, 0.5, 2, vague);
  EXPECT_FALSE(result.out);
  EXPECT_TRUE(result.inaccurate);
}

/// The world may lie turned: all cameras alike, so that they agree nevertheless.
TEST(TrackerKnocks, AnErrorThatAllCamerasShareExplainsNoTurn) {
  geometry::Rig turned_world = paperRig();
  const auto parameters = 4 * geometry::kParameters;
  Eigen::MatrixXd by_turn = Eigen::MatrixXd::Zero(parameters, 3);
  for (std::size_t camera = 0; camera < 4; ++camera) {
    const Eigen::Index first = geometry::firstParameter(camera);
    by_turn.block<3, 3>(first + geometry::kRotation, 0).setIdentity();
    by_turn.block<3, 3>(first + geometry::kPosition, 0) =
        -geometry::so3::skew(turned_world.cameras[camera].camera.center());
  }
  turned_world.covariance = 1e-2 * 1e-2 * by_turn * by_turn.transpose();
  const auto out = knock(turned_world, oneWanderer(1), kTurn, 0.5, 2).out;
  ASSERT_TRUE(out);
  EXPECT_LE(*out, 1.0);
}

/// The other direction moves spots along the rays of the other camera, so that they still meet.
TEST(TrackerKnocks, OfTwoCamerasNoWrongPointsAreTracked) {
  std::size_t leds = 0, tracked = 0;
  for (const double degrees : {1.0, 2.0, 3.0}) {
    for (const unsigned seed : {1u, 2u, 3u}) {
      const Knock result = knock(firstOfPaperRig(2), wanderers(4, seed), degrees, 0.0, seed);
      ASSERT_TRUE(result.out && result.used) << degrees;
      EXPECT_LE(*result.out, 0.5) << degrees;
      EXPECT_LE(*result.used, 2.0) << degrees;
      EXPECT_LT(result.worst, 0.05) << degrees << " degrees, seed " << seed;
      leds += result.leds;
      tracked += result.tracked;
    }
  }
  // How soon it fits again differs by chance: 0.2 to 0.34 of a knock's time.
  EXPECT_GT(tracked, 0.27 * leds) << "tracked again";
}

/// Two LEDs come so close before one camera that they are one spot, outside the gates of both; a
/// third is hidden from it. In the free slot it shows a reflection.
TEST(TrackerKnocks, ACameraBeforeWhichLedsMergeIsNotLeftOut) {
  const geometry::Rig rig = paperRig();
  const geometry::Camera& camera = rig.cameras[kKnocked].camera;
  const Eigen::Vector3d place(1.25, 1.25, 1.0);
  const Eigen::Vector3d line_of_sight = (camera.center() - place).normalized();
  const Eigen::Vector3d aside = camera.world_from_camera.linear().col(0);
  const double pixel = (camera.center() - place).norm() / camera.intrinsics.fx;  // [m]
  const Path approaching = [&](double time) {
    const double pixels = 15.0 + 200.0 * std::max(0.0, 1.0 - (time - 1000.0) / 4.0);
    return Eigen::Vector3d(place + 0.3 * line_of_sight + pixels * pixel * aside);
  };
  SceneOptions options;
  options.merging_distance = 24.0;
  options.hidden = [](std::size_t which, std::size_t led, double time) {
    return which == kKnocked && led == 2 && time > 1004.0;
  };
  Scene scene(rig, {still(place), approaching, still({0.6, 0.8, 0.7}), still({1.9, 1.8, 1.4})},
              options, 1);
  Tracker tracker(rig, exactOptions());
  std::size_t merged = 0;
  for (double time = 0.0; time < 6.0;) {
    const SceneImage& next = scene.next();
    time = next.true_time - options.start;
    CameraImage image = next.image;
    if (next.camera == kKnocked && image.spots.size() < image.maximum_spots) {
      merged += image.spots.size() == 2;
      image.spots.emplace_back();
      image.spots.back().pixel = {900.0, 700.0};
    }
    tracker.add(next.camera, image);
    while (tracker.next()) {
    }
    ASSERT_FALSE(isMisfit(tracker, kKnocked)) << time;
  }
  EXPECT_GT(merged, 150u);
}

}  // namespace
}  // namespace wiimote_tracker::tracking::test
