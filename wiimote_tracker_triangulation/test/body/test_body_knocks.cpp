// A camera that was turned since its calibration, or is turned while bodies are tracked.
#include "body/body_scene.h"
#include "body/body_tracker.h"
#include "wiimote_tracker_triangulation/tracking/tracker.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker::body {
namespace {

using test::Motion;

constexpr std::size_t kKnocked = 1;
constexpr double kForever = std::numeric_limits<double>::infinity();

struct Knock {
  double degrees;
  double begin;  // since the start [s]
  double end;    // turned back [s]
};

struct Result {
  std::optional<double> out;   // after the knock the camera is named [s]
  std::optional<double> used;  // after it is turned back it is named no more [s]
  std::size_t alarms = 0;      // images after which another camera is named
  // Of bodies, from 1 s after the start and not within 1 s after the knock:
  double bodies = 0.0;
  double tracked = 0.0;
  double wrong = 0.0;          // beyond five standard deviations
  double squared_error = 0.0;  // sum [m^2]

  double rms() const { return std::sqrt(squared_error / tracked); }
};

/// @param knock of the camera kKnocked, if the rig has it
Result follow(const geometry::Rig& rig,
              const std::vector<Constellation>& bodies,
              const std::vector<Motion>& motions,
              const Knock& knock,
              unsigned seed) {
  geometry::Rig turned = rig;
  turned.cameras[kKnocked].camera.world_from_camera.rotate(
      Eigen::AngleAxisd(knock.degrees * M_PI / 180.0, Eigen::Vector3d(0.6, 0.8, 0.0)));
  tracking::test::SceneOptions options;
  options.pixel_noise = 0.5;
  options.maximum_spots = 8;
  std::vector<tracking::test::Path> leds;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    for (const tracking::test::Path& path : test::pathsOf(bodies[b], motions[b]))
      leds.push_back(path);
  }
  tracking::test::Scene right(rig, leds, options, seed);
  tracking::test::Scene wrong(turned, leds, options, seed);  // exposes at the same times
  tracking::TrackerOptions tracker_options = tracking::test::exactOptions();
  tracker_options.pixel_stddev = options.pixel_noise;
  tracking::Tracker tracker(rig, tracker_options);
  BodyTracker body_tracker((BodyTrackerOptions()));
  body_tracker.setBodies(bodies);
  body_tracker.setRig(rig);
  Result result;
  for (double time = 0.0; time < 8.0;) {
    const tracking::test::SceneImage& shown = right.next();
    const tracking::test::SceneImage& moved = wrong.next();
    time = shown.true_time - options.start;
    const bool is_turned = time >= knock.begin && time < knock.end;
    tracking::CameraImage image = is_turned ? moved.image : shown.image;
    body_tracker.take(shown.camera, {}, &image, tracker.isDoubtful(shown.camera));
    tracker.add(shown.camera, image);
    while (tracker.next()) {
    }
    for (std::size_t camera = 0; camera < rig.cameras.size(); ++camera) {
      const bool is_named = tracker.cameraFault(camera).has_value();
      if (camera != kKnocked || time < knock.begin)
        result.alarms += is_named;
      else if (is_turned && is_named && !result.out)
        result.out = time - knock.begin;
      else if (time >= knock.end && !is_named && !result.used)
        result.used = time - knock.end;
    }
    const BodySnapshot* snapshot = body_tracker.next();
    if (!snapshot || time < 1.0 || (time >= knock.begin && time < knock.begin + 1.0))
      continue;
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      result.bodies += 1.0;
      const std::optional<BodyEstimate>& body = snapshot->bodies[b];
      if (!body || !body->tracked)
        continue;
      result.tracked += 1.0;
      const Eigen::Vector3d error =
          body->world_from_body.translation() - motions[b](snapshot->time).translation();
      const double variance = body->covariance.topLeftCorner<3, 3>().trace();
      result.wrong += error.squaredNorm() > 25.0 * variance;
      result.squared_error += error.squaredNorm();
    }
  }
  return result;
}

/// As handheld(), elsewhere.
Eigen::Isometry3d besideIt(double time) {
  return Eigen::Translation3d(-0.35, 0.3, 0.25) * test::handheld(time + 1.7);
}

geometry::Rig firstOfPaperRig(std::size_t cameras) {
  geometry::Rig rig = tracking::test::paperRig();
  rig.cameras.resize(cameras);
  return rig;
}

geometry::Rig withoutKnocked(geometry::Rig rig) {
  rig.cameras.erase(rig.cameras.begin() + kKnocked);
  return rig;
}

/// The camera is named within a second and left out, and poses are as good as without it.
void expectLeftOut(std::size_t cameras,
                   const std::vector<Constellation>& bodies,
                   const std::vector<Motion>& motions,
                   const Knock& knock,
                   unsigned seed) {
  const geometry::Rig rig = firstOfPaperRig(cameras);
  const std::string what = std::to_string(cameras) + " cameras, " + std::to_string(bodies.size()) +
                           " bodies, " + std::to_string(knock.degrees) + " degrees from " +
                           std::to_string(knock.begin) + " s, seed " + std::to_string(seed);
  const Result result = follow(rig, bodies, motions, knock, seed);
  const Result without =
      follow(withoutKnocked(rig), bodies, motions, {0.0, knock.begin, kForever}, seed);
  ASSERT_TRUE(result.out) << what;
  EXPECT_LE(*result.out, 1.0) << what;
  if (knock.end < kForever) {
    ASSERT_TRUE(result.used) << what;
    EXPECT_LE(*result.used, 1.0) << what;
  }
  EXPECT_EQ(0u, result.alarms) << what;
  EXPECT_GE(result.tracked, 0.999 * without.tracked * result.bodies / without.bodies) << what;
  EXPECT_LE(result.wrong, 0.001 * result.tracked) << what;
  EXPECT_LE(result.rms(), 1.1 * without.rms()) << what;
}

TEST(BodyKnocks, ACameraKnockedWhileABodyIsTrackedIsLeftOut) {
  for (const std::size_t cameras : {3u, 4u}) {
    for (const double degrees : {1.0, 3.5, 10.0})
      expectLeftOut(cameras, {test::fourLeds()}, {test::handheld}, {degrees, 3.0, 5.5}, 1);
  }
}

TEST(BodyKnocks, ACameraKnockedBeforeTheStartIsLeftOut) {
  for (const std::size_t cameras : {3u, 4u}) {
    for (const double degrees : {1.0, 3.5, 10.0}) {
      for (const Motion& motion : {Motion(test::handheld), Motion(test::held)})
        expectLeftOut(cameras, {test::fourLeds()}, {motion}, {degrees, 0.0, kForever}, 2);
    }
  }
}

TEST(BodyKnocks, ItIsLeftOutForTwoBodies) {
  const std::vector<Constellation> bodies = {test::fourLeds(), test::threeLeds()};
  for (const double begin : {0.0, 3.0})
    expectLeftOut(4, bodies, {test::handheld, besideIt}, {3.5, begin, kForever}, 3);
}

/// Nobody knows which of two cameras was moved.
TEST(BodyKnocks, OfTwoCamerasNoBodyIsTrackedUntilTheyFitAgain) {
  const Result turned =
      follow(firstOfPaperRig(2), {test::fourLeds()}, {test::handheld}, {3.5, 3.0, kForever}, 4);
  ASSERT_TRUE(turned.out);
  EXPECT_LE(*turned.out, 1.0);
  EXPECT_LE(turned.tracked, 0.5 * turned.bodies) << "only before";
  EXPECT_LE(turned.wrong, 0.001 * turned.tracked);
  const Result back =
      follow(firstOfPaperRig(2), {test::fourLeds()}, {test::handheld}, {3.5, 3.0, 4.5}, 4);
  ASSERT_TRUE(back.used);
  EXPECT_LE(*back.used, 2.0);
  EXPECT_GE(back.tracked, 0.6 * back.bodies) << "tracked again";
}

}  // namespace
}  // namespace wiimote_tracker::body
