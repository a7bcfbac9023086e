// What mode tracks adds in the code that node and track_bag share: messages in, messages out. More
// than 400 lines, because all of it is seen in the points only.
#include "ros/studio.h"
#include "wiimote_tracker_triangulation/geometry/linear_algebra.h"
#include "wiimote_tracker_triangulation/identity/blink_codes.h"
#include "wiimote_tracker_triangulation/identity/schemes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace wiimote_tracker {
namespace {

using namespace studio;

/// Whether the 95 % ellipsoid holds the truth.
template <typename Covariance>
bool isInEllipsoid(const Vector3d& error, const Covariance& row_major) {
  const Eigen::Map<const Eigen::Matrix3d> covariance(row_major.data());
  return geometry::squaredMahalanobis(error, covariance) < 7.815;
}

TEST(Clocks, ACameraWithAnotherClockIsNamedOnceAndLeftOut) {
  Studio studio(parametersOf(TrackerMode::kTracks));
  studio.spoil = [&](std::size_t camera, IrBlobArray* image) {
    const ros::Duration ahead(camera == 2 ? 0.5 : 0.0);
    image->header.stamp += ahead;
    image->arrival += ahead;
  };
  studio.film(1.0, {onCircle});
  EXPECT_EQ(1, studio.heard.problemsWith("the clock of the computer of camera_2 is 0.5"));
  EXPECT_NE(std::string::npos, studio.tracker.statistics().camera(2).problem.find("chrony"));
  studio.expectNear("led", 1000.3, onCircle);
  EXPECT_GT(studio.pointsOf("led", 1000.3).size(), 130u);
}

/// As continuous calibration does every half minute.
TEST(Clocks, AFaultThatGoesOnIsNotReportedAgainWithEachRig) {
  Studio studio(parametersOf(TrackerMode::kTracks));
  double ahead = 0.5;
  studio.spoil = [&](std::size_t camera, IrBlobArray* image) {
    const ros::Duration error(camera == 2 ? ahead : 0.0);
    image->header.stamp += error;
    image->arrival += error;
  };
  const std::string fault = "the clock of the computer of camera_2 is";
  const auto takeAnotherRig = [&] {
    studio.rig.cameras[0].camera.world_from_camera.pretranslate(Vector3d(1e-5, 0.0, 0.0));
    EXPECT_TRUE(studio.tracker.takeRig(toMessage(studio.rig)).points);
  };
  studio.film(1.0, {onCircle});
  takeAnotherRig();
  studio.film(1.0, {onCircle});
  EXPECT_EQ(1, studio.heard.problemsWith(fault));

  ahead = 0.0;
  studio.film(2.0, {onCircle});
  takeAnotherRig();
  ahead = 0.5;
  studio.film(1.0, {onCircle});
  EXPECT_EQ(2, studio.heard.problemsWith(fault)) << "it came back";
}

TEST(Clocks, AnImageFromAnotherCenturyChangesNothing) {
  Studio studio(parametersOf(TrackerMode::kTracks));
  studio.film(0.5, {onCircle});
  IrBlobArray image = studio.image(0, studio.now, {onCircle});
  image.header.stamp = image.arrival = ros::TIME_MAX;
  studio.tracker.takeImage("camera_0", image);
  studio.film(0.5, {onCircle});
  studio.expectNear("led", 1000.3, onCircle);
  EXPECT_GT(studio.pointsOf("led", 1000.5).size(), 140u);
}

TEST(Labels, ThatMayBeWrongAreNamed) {
  TrackingParameters parameters = parametersOf(TrackerMode::kTracks);
  parameters.labels = {"led", "second"};
  Studio studio(parameters);
  const Paths paths = {onCircle, besideCircle};
  studio.film(1.0, paths);
  studio.film(20.0, {});
  EXPECT_EQ(0, studio.heard.problemsWith("may be wrong"));
  const double again = studio.now;
  studio.film(1.0, paths);
  EXPECT_GE(studio.heard.problemsWith("labels may be wrong"), 1);
  const auto points = studio.pointsOf("led", again);
  ASSERT_FALSE(points.empty());
  for (const auto& [time, point] : points)
    EXPECT_NEAR(0.5, point.label_confidence, 0.1) << time;
}

TEST(Labels, AreNotRememberedAtPlacesOfAnotherWorld) {
  TrackingParameters parameters = parametersOf(TrackerMode::kTracks);
  parameters.labels = {"led", "second"};
  Studio studio(parameters);
  const auto take = [&](const std::vector<std::size_t>& cameras, double way) {
    for (const std::size_t camera : cameras)
      studio.rig.cameras[camera].camera.world_from_camera.pretranslate(Vector3d(way, 0.0, 0.0));
    EXPECT_TRUE(studio.tracker.takeRig(toMessage(studio.rig)).points);
  };
  studio.film(1.0, {onCircle, besideCircle});
  take({1}, 0.5);
  take({0, 1, 2}, 1e-4);
  EXPECT_EQ(2u, studio.tracker.labels().places().size()) << "a knock, and a step of an approach";
  take({0, 1, 2}, 0.5);
  EXPECT_TRUE(studio.tracker.labels().places().empty());
  const double again = studio.now;
  studio.film(1.0, {onCircle, besideCircle});
  EXPECT_EQ(2u, studio.tracker.labels().places().size());
  const auto points = studio.pointsOf("led", again + 0.5);
  ASSERT_FALSE(points.empty());
  EXPECT_TRUE(std::isnan(points.back().second.label_confidence));
}

/// The LED is off while the lamps are masked.
TEST(Labels, GoBackFromALampThatIsMaskedToTheLed) {
  const auto lamp = [](double) { return Vector3d(0.1, 0.0, 0.6); };
  TrackingParameters parameters = parametersOf(TrackerMode::kTracks);
  for (const std::vector<std::string>& labels :
       std::vector<std::vector<std::string>>{{"led", "second"}, {"led"}}) {
    parameters.labels = labels;
    Studio studio(parameters);
    studio.film(1.0, {onCircle});
    studio.film(1.0, {onCircle, lamp});
    studio.film(11.0, {lamp});
    for (geometry::RigCamera& camera : studio.rig.cameras)
      camera.masks = {{*camera.camera.project(lamp(0.0)), 8.0}};
    studio.tracker.takeRig(toMessage(studio.rig));
    studio.film(2.0, {lamp});
    const double again = studio.now;
    studio.film(1.0, {lamp, onCircle});
    studio.expectNear("led", again, onCircle);
    const auto points = studio.pointsOf("led", again);
    ASSERT_FALSE(points.empty());
    // Of two labels, the one that was never given may be that of the LED, too.
    EXPECT_GE(points.back().second.label_confidence, labels.size() == 1 ? 1.0 : 0.5);
  }
}

/// One LED comes to another one; their spots merge for a second, then one of them leaves.
TEST(Labels, OfOneLedCannotBeMixedUp) {
  const auto way = [](double since) { return since < 0.0 ? 0.0 : std::min(0.5, since * since); };
  const Paths paths = {
      [&](double time) { return Vector3d(way(1001.5 - time), way(time - 1002.5), 0.5); },
      [](double) { return Vector3d(0.0, 0.0, 0.5); }};
  TrackingParameters parameters = parametersOf(TrackerMode::kTracks);
  for (const std::vector<std::string>& labels :
       std::vector<std::vector<std::string>>{{"led", "second"}, {"led"}}) {
    parameters.labels = labels;
    Studio studio(parameters);
    studio.is_dark = [](std::size_t led, double time) {
      return led == 1 && time > 1001.5 && time < 1002.5;
    };
    studio.film(4.0, paths);
    EXPECT_EQ(labels.size() > 1, studio.heard.problemsWith("labels may be wrong") > 0);
    EXPECT_LT(studio.pointsOf("led", 1003.5).back().second.label_confidence, 0.8);
  }
}

TEST(Identity, BlinkingLedsKeepTheirLabelsThroughDarkness) {
  constexpr double kChip = 0.023;
  const std::vector<std::string> words = {"01011111", "01010101"};
  TrackingParameters parameters = parametersOf(TrackerMode::kTracks);
  parameters.labels = {"lamp"};
  parameters.identity.codes =
      identity::cyclicCodes({{"left", words[0]}, {"right", words[1]}}, kChip, 0.01);
  parameters.estimator.tracks =
      identity::forBlinking(*parameters.identity.codes, parameters.estimator.tracks);
  Studio studio(parameters);
  const auto chip = [&](double time) {
    return static_cast<std::size_t>((time - 999.0) / kChip) % words[0].size();
  };
  studio.is_dark = [&](std::size_t led, double time) {
    return led < words.size() && words[led][chip(time)] == '0';
  };
  const auto lamp = [](double t) { return Vector3d(0.3 * std::sin(t), -0.1, 0.4); };
  const Paths paths = {onCircle, besideCircle, lamp};
  studio.film(3.0, paths);

  const std::vector<std::string> names = {"left", "right", "lamp"};
  for (std::size_t led = 0; led < names.size(); ++led) {
    const auto points = studio.pointsOf(names[led], 1001.0);
    ASSERT_GT(points.size(), 500u) << names[led];
    const TrackedPoint& first = points.front().second;
    double longest_unseen = 0.0;
    std::size_t inside = 0;
    for (const auto& [time, point] : points) {
      const Vector3d error = vectorOf(point.position) - paths[led](time);
      ASSERT_LT(error.norm(), 10.0 * kNear) << names[led] << " at " << time;
      inside += isInEllipsoid(error, point.position_covariance);
      EXPECT_EQ(first.id, point.id);
      EXPECT_EQ(first.label_since, point.label_since);
      const double unseen = time - point.last_observed.toSec();
      longest_unseen = std::max(longest_unseen, unseen);
      // Darkness shorter than tracked_time leaves it tracked.
      EXPECT_EQ(TrackedPoint::TRACKED, point.state) << names[led] << " at " << time;
      EXPECT_GE(point.rays_used, 2u);
    }
    EXPECT_GT(static_cast<double>(inside), 0.9 * static_cast<double>(points.size())) << names[led];
    if (led < words.size()) {
      EXPECT_GT(first.label_confidence, 0.999);
      EXPECT_LT(first.label_since.toSec(), 1001.0);
      EXPECT_GT(longest_unseen, 0.8 * kChip) << "it is dark for so long";
    } else {
      EXPECT_TRUE(std::isnan(first.label_confidence));
      EXPECT_TRUE(first.label_since.isZero());
    }
  }
  EXPECT_TRUE(studio.heard.problems.empty());
}

TEST(Prediction, IsForTheArrivalOfTheNewestImage) {
  TrackingParameters parameters;
  parameters.output.predict_to_now = true;
  Studio studio(parameters);
  studio.film(1.0, {onCircle});
  studio.expectNear("led", 1000.5, onCircle);
  for (const auto& array : studio.heard.arrays)
    ASSERT_NEAR(array->latest_arrival.toSec(), array->header.stamp.toSec(), 1e-6);
}

TEST(Prediction, AtARateIsForTheTimesOfTheRate) {
  TrackingParameters parameters;
  parameters.output.on_update = false;
  parameters.output.rate = 250.0;
  parameters.output.predict_to_now = true;
  Studio studio(parameters);
  studio.film(1.0, {onCircle});
  studio.expectNear("led", 1000.5, onCircle);
  const auto points = studio.pointsOf("led", 1000.5);
  ASSERT_GT(points.size(), 100u);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double tick = points[i].first * 250.0;
    ASSERT_NEAR(std::round(tick), tick, 1e-3);
    if (i > 0) {
      ASSERT_NEAR(0.004, points[i].first - points[i - 1].first, 1e-6) << "none is left out";
    }
  }
}

TEST(Prediction, AtARateGoesOnAfterImagesWithAWrongClock) {
  TrackingParameters parameters;
  parameters.output.on_update = false;
  parameters.output.rate = 250.0;
  parameters.output.predict_to_now = true;
  Studio studio(parameters);
  studio.film(0.5, {onCircle});
  IrBlobArray image = studio.image(0, studio.now, {onCircle});
  image.header.stamp = image.arrival = ros::TIME_MAX;
  studio.tracker.takeImage("camera_0", image);
  studio.spoil = [&](std::size_t camera, IrBlobArray* taken) {
    const ros::Duration ahead(camera == 2 ? 0.3 : 0.0);
    taken->header.stamp += ahead;
    taken->arrival += ahead;
  };
  studio.film(1.0, {onCircle});
  const auto points = studio.pointsOf("led", 1001.0);
  EXPECT_GT(points.size(), 100u);
  for (const auto& [time, point] : points)
    EXPECT_LT(time, studio.now) << "not at the time of the camera whose clock is ahead";
}

TEST(MessageTracker, NamesACameraWhosePlaceWasTypedInMillimetres) {
  Heard heard;
  MessageTracker tracker(TrackingParameters(), &heard);
  geometry::test::Random random(84);
  Rig rig = geometry::test::randomRig(random, 3);
  tracker.takeRig(toMessage(rig));
  EXPECT_TRUE(heard.problems.empty());
  rig.cameras[1].camera.world_from_camera.translation() *= 1000.0;
  tracker.takeRig(toMessage(rig));
  ASSERT_EQ(1u, heard.problems.size());
  EXPECT_EQ(0u, heard.problems[0].find("camera_1 is ")) << heard.problems[0];
}

TEST(ImuOfABody, IsNotUsedIfZDoesNotPointUp) {
  Heard heard;
  MessageTracker tracker(TrackingParameters(), &heard);
  body::Constellation wand{"wand", {{0.0, 0.0, 0.0}, {0.1, 0.0, 0.0}, {0.0, 0.2, 0.0}}};
  wand.imu = body::ImuMount{"/imu"};
  tracker.setBodies({wand});
  geometry::test::Random random(83);
  Rig rig = geometry::test::randomRig(random, 3);
  for (const double up : {1.0, -1.0}) {
    for (geometry::RigCamera& camera : rig.cameras)
      camera.gravity = camera.camera.world_from_camera.linear().transpose() *
                       Vector3d(0.5, 0.0, up * 9.8);  // 3 degrees off, as accelerometers are
    rig.cameras[0].camera.intrinsics.fx += 1.0;       // another rig
    tracker.takeRig(toMessage(rig));
    sensor_msgs::Imu sample;
    sample.header.stamp = ros::Time(100.0);
    tracker.takeInertial("wand", sample);
    tracker.takeInertial("wand", sample);
    EXPECT_EQ(up > 0.0 ? 0 : 1, heard.problemsWith("177 degrees from up"));
  }
}

/// How often an IMU without samples is reported while its body is seen for 2 s, hidden for 1 s, and
/// seen for 1.5 s.
long reportsOfAMissingImu(double up) {
  Studio studio(parametersOf(TrackerMode::kTracks));
  body::Constellation wand{"wand", {{0.2, 0.0, 0.3}, {-0.15, 0.05, 0.3}, {0.0, 0.15, 0.4}}};
  wand.imu = body::ImuMount{"/imu"};
  studio.tracker.setBodies({wand});
  for (geometry::RigCamera& camera : studio.rig.cameras)
    camera.gravity =
        camera.camera.world_from_camera.linear().transpose() * Vector3d(0.0, 0.0, 9.8 * up);
  studio.tracker.takeRig(toMessage(studio.rig));
  Paths leds;
  for (const Vector3d& led : wand.leds)
    leds.push_back([led](double) { return led; });
  studio.film(2.0, leds);
  EXPECT_EQ(studio.heard.bodies.back().bodies.at(0).state,
            wiimote_tracker_msgs::TrackedBody::TRACKED);
  studio.film(1.0, {});
  studio.film(1.5, leds);
  return studio.heard.problemsWith("the IMU of wand (/imu) is not used");
}

TEST(ImuOfABody, ThatIsNotUsedIsReported) {
  EXPECT_EQ(reportsOfAMissingImu(1.0), 1);
}

TEST(ImuOfABody, IsNotMissedIfZDoesNotPointUp) {
  EXPECT_EQ(reportsOfAMissingImu(-1.0), 0);
}

TEST(Bodies, ThatAreNoLongerWantedAreReportedLostOnce) {
  using wiimote_tracker_msgs::TrackedBody;
  Studio studio(parametersOf(TrackerMode::kTracks));
  const body::Constellation wand{"wand", {{0.2, 0.0, 0.3}, {-0.15, 0.05, 0.3}, {0.0, 0.15, 0.4}}};
  studio.tracker.setBodies({wand});
  Paths leds;
  for (const Vector3d& led : wand.leds)
    leds.push_back([led](double) { return led; });
  studio.film(1.0, leds);
  auto& heard = studio.heard.bodies;
  ASSERT_EQ(heard.back().bodies.size(), 1u);
  ASSERT_EQ(heard.back().bodies[0].state, TrackedBody::TRACKED);
  heard.clear();
  studio.tracker.setBodies({});
  ASSERT_EQ(heard.size(), 1u);
  ASSERT_EQ(heard[0].bodies.size(), 1u);
  EXPECT_EQ(heard[0].bodies[0].name, "wand");
  EXPECT_EQ(heard[0].bodies[0].state, TrackedBody::LOST);
  studio.tracker.setBodies({wand});
  EXPECT_EQ(heard.size(), 1u);
}

/// Spots of bodies do not show it.
TEST(Bodies, AskForALedThatShowsTheClockOfACameraThatHasReconnected) {
  Studio studio(parametersOf(TrackerMode::kTracks));
  for (geometry::RigCamera& camera : studio.rig.cameras) {
    camera.time_offset = 0.0;
    camera.time_offset_rule = geometry::TimeOffsetRule::kOneEpoch;
  }
  studio.tracker.takeRig(toMessage(studio.rig));
  const body::Constellation wand{"wand", {{0.2, 0.0, 0.3}, {-0.15, 0.05, 0.3}, {0.0, 0.15, 0.4}}};
  studio.tracker.setBodies({wand});
  studio.spoil = [&](std::size_t camera, IrBlobArray* image) {
    image->clock_epoch = camera == 2 ? 1 : 0;
  };
  Paths leds;
  for (const Vector3d& led : wand.leds)
    leds.push_back([led](double) { return led; });
  const auto asked = [&](std::size_t camera) {
    return studio.tracker.statistics().describeClock(camera, "cam");
  };
  EXPECT_EQ(asked(2), "") << "no image";
  studio.film(5.0, leds);
  EXPECT_EQ(
      asked(2),
      "cam has a new clock since it was calibrated, known to +- 5 ms only: move one LED alone "
      "for 10 s where it and two other cameras see it");
  EXPECT_EQ(asked(0), "");
  leds.emplace_back(onCircle);
  studio.film(10.0, leds);
  EXPECT_EQ(asked(2), "");
}

/// Free LEDs show the offset of a camera that has reconnected; the body is in no view.
TEST(Bodies, AreAtTheTimesThatMotionHasCorrected) {
  constexpr double kLate = 0.002;  // stamps of camera 2, which exposes at 6 ms of each period [s]
  Studio studio(parametersOf(TrackerMode::kTracks));
  for (geometry::RigCamera& camera : studio.rig.cameras) {
    camera.time_offset = 0.0;
    camera.time_offset_rule = geometry::TimeOffsetRule::kOneEpoch;
  }
  studio.tracker.takeRig(toMessage(studio.rig));
  studio.tracker.setBodies({{"wand", {{0.2, 0.0, 0.3}, {-0.15, 0.05, 0.3}, {0.0, 0.15, 0.4}}}});
  studio.spoil = [&](std::size_t camera, IrBlobArray* image) {
    if (camera != 2)
      return;
    image->header.stamp += ros::Duration(kLate);
    image->arrival += ros::Duration(kLate);
    image->clock_epoch = 1;
  };
  studio.film(8.0, {onCircle, besideCircle});
  const auto& bodies = studio.heard.bodies;
  ASSERT_GT(bodies.size(), 2000u);
  for (std::size_t i = bodies.size() - 300; i < bodies.size(); ++i) {
    const double phase = std::remainder(bodies[i].header.stamp.toSec() - 1000.0, kPeriod);
    const double nearest = std::min({std::abs(phase), std::abs(phase - 0.003),
                                     std::abs(phase + 0.004)});  // 6 ms before the next period
    EXPECT_LT(nearest, 0.001) << i;
  }
}

}  // namespace
}  // namespace wiimote_tracker
