// The code that node and track_bag share, in both modes: messages in, messages out.
#include "geometry/random_rigs.h"
#include "ros/message_tracker.h"
#include "wiimote_tracker_triangulation/geometry/error.h"
#include "wiimote_tracker_triangulation/identity/blinking_tracks.h"
#include "wiimote_tracker_triangulation/identity/schemes.h"
#include "wiimote_tracker_triangulation/ros/conversions.h"

#include <gtest/gtest.h>
#include <ros/serialization.h>
#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace wiimote_tracker {
namespace {

using Eigen::Vector3d;
using geometry::Rig;
using tracking::Mode;
using wiimote_tracker_msgs::IrBlobArray;
using wiimote_tracker_msgs::RigCalibration;
using wiimote_tracker_msgs::TrackedPoint;
using wiimote_tracker_msgs::TrackedPointArray;
using wiimote_tracker_msgs::TrackedPointArrayConstPtr;
using wiimote_tracker_msgs::ZoneEvent;

constexpr double kPeriod = 0.01;
constexpr double kDelay = 0.002;  // from exposure to arrival [s]

// Bound on errors with exact pixels, which come from interpolation or the motion model on a circle
// of 0.5 m at 0.5 m/s [m].
constexpr double kNear = 2e-3;

using Paths = std::vector<std::function<Vector3d(double)>>;

Vector3d onCircle(double t) {
  return {0.5 * std::cos(t), 0.5 * std::sin(t), 0.2};
}

Vector3d besideCircle(double t) {
  return onCircle(t) + Vector3d(0.0, 0.0, 0.4);
}

struct Heard : MessageSink {
  void onPoints(const TrackedPointArrayConstPtr& array,
                const std::vector<tracking::CameraView>& views) override {
    arrays.push_back(array);
    view_count = views.size();
  }
  void onZoneEvent(const ZoneEvent& event) override { events.push_back(event); }
  void onTriggeredPoints(const TrackedPointArray& array) override { triggered.push_back(array); }
  void onProblem(const std::string& sentence) override { problems.push_back(sentence); }

  /// How many of the problems contain these words.
  long problemsWith(const std::string& words) const {
    return std::count_if(problems.begin(), problems.end(), [&](const std::string& problem) {
      return problem.find(words) != std::string::npos;
    });
  }

  std::vector<TrackedPointArrayConstPtr> arrays;
  std::vector<ZoneEvent> events;
  std::vector<TrackedPointArray> triggered;
  std::vector<std::string> problems;
  std::size_t view_count = 0;
};

TrackingParameters parametersOf(Mode mode) {
  TrackingParameters parameters;
  parameters.estimator.mode = mode;
  return parameters;
}

/// A tracker and three cameras, each with its own phase; images come in the order of arrival.
class Studio {
 public:
  explicit Studio(const TrackingParameters& parameters) : tracker(parameters, &heard) {
    geometry::test::Random random(81);
    rig = geometry::test::randomRig(random, 3);
    tracker.takeRig(toMessage(rig));
  }

  IrBlobArray image(std::size_t camera, double time, const Paths& leds) const {
    const geometry::Camera& c = rig.cameras[camera].camera;
    IrBlobArray image;
    image.header.stamp.fromSec(time);
    image.camera = c.name;
    image.identity = c.identity;
    image.arrival.fromSec(time + kDelay);
    image.stamp_stddev = 1e-6;
    image.width = static_cast<std::uint32_t>(c.intrinsics.width);
    image.height = static_cast<std::uint32_t>(c.intrinsics.height);
    image.max_blobs = 4;
    for (std::size_t i = 0; i < leds.size(); ++i) {
      if (is_dark && is_dark(i, time))
        continue;
      if (const auto pixel = c.project(leds[i](time))) {
        wiimote_tracker_msgs::IrBlob blob;
        blob.x = pixel->x();
        blob.y = pixel->y();
        blob.size = std::numeric_limits<float>::quiet_NaN();
        image.blobs.push_back(blob);
      }
    }
    return image;
  }

  void film(double duration, const Paths& leds) {
    const double end = now + duration;
    for (; now < end - 1e-6; now += kPeriod) {
      for (std::size_t camera = 0; camera < 3; ++camera) {
        IrBlobArray taken = image(camera, now + 0.003 * static_cast<double>(camera), leds);
        if (spoil)
          spoil(camera, &taken);
        tracker.takeImage(rig.cameras[camera].camera.name, taken);
      }
    }
  }

  /// The points of this label in the outputs after a time.
  std::vector<std::pair<double, TrackedPoint>> pointsOf(const std::string& label,
                                                        double after) const {
    std::vector<std::pair<double, TrackedPoint>> points;
    for (const auto& array : heard.arrays) {
      for (const TrackedPoint& point : array->points) {
        if (point.label == label && array->header.stamp.toSec() > after)
          points.emplace_back(array->header.stamp.toSec(), point);
      }
    }
    return points;
  }

  void expectNear(const std::string& label,
                  double after,
                  const std::function<Vector3d(double)>& path) const {
    const auto points = pointsOf(label, after);
    EXPECT_FALSE(points.empty()) << label;
    for (const auto& [time, point] : points) {
      const Vector3d position(point.position.x, point.position.y, point.position.z);
      ASSERT_LT((position - path(time)).norm(), kNear) << label << " at " << time;
    }
  }

  Heard heard;
  MessageTracker tracker;
  Rig rig;
  double now = 1000.0;
  std::function<void(std::size_t, IrBlobArray*)> spoil;
  std::function<bool(std::size_t led, double time)> is_dark;
};

class InBothModes : public testing::TestWithParam<Mode> {};

INSTANTIATE_TEST_SUITE_P(MessageTracker,
                         InBothModes,
                         testing::Values(Mode::kTracks, Mode::kInstant),
                         [](const auto& info) {
                           return info.param == Mode::kTracks ? "Tracks" : "Instant";
                         });

TEST_P(InBothModes, SeveralLedsHaveTheirLabelsAndPlaces) {
  TrackingParameters parameters = parametersOf(GetParam());
  parameters.labels = {"low", "high"};
  Studio studio(parameters);
  studio.film(1.0, {onCircle, besideCircle});
  // The order of two LEDs that appear together is arbitrary.
  const bool swapped = studio.pointsOf("low", 1000.5).at(0).second.position.z > 0.4;
  studio.expectNear("low", 1000.5, swapped ? besideCircle : onCircle);
  studio.expectNear("high", 1000.5, swapped ? onCircle : besideCircle);
  for (std::size_t i = 1; i < studio.heard.arrays.size(); ++i)
    ASSERT_GT(studio.heard.arrays[i]->header.stamp, studio.heard.arrays[i - 1]->header.stamp);
  EXPECT_GT(studio.heard.arrays.size(), 250u);
  const TrackedPointArray& last = *studio.heard.arrays.back();
  EXPECT_EQ(studio.rig.id(), last.rig_id);
  EXPECT_EQ(GetParam() == Mode::kTracks ? "track" : "maximum_likelihood", last.method);
  EXPECT_EQ(2u, last.points.size());
  EXPECT_EQ(3u, studio.heard.view_count);
  EXPECT_TRUE(studio.heard.problems.empty());
}

TEST_P(InBothModes, ALostLedIsReportedOnceAndItsLabelReused) {
  Studio studio(parametersOf(GetParam()));
  studio.film(0.5, {onCircle});
  studio.film(5.0, {});
  const auto lost = [&] {
    const auto points = studio.pointsOf("led", 0.0);
    return std::count_if(points.begin(), points.end(), [](const auto& point) {
      return point.second.state == TrackedPoint::LOST;
    });
  };
  EXPECT_EQ(1, lost());
  EXPECT_TRUE(studio.heard.arrays.back()->points.empty());
  const std::uint32_t id = studio.pointsOf("led", 0.0).at(0).second.id;
  const double back = studio.now;
  studio.film(0.5, {onCircle});
  studio.expectNear("led", back + 0.2, onCircle);
  EXPECT_NE(id, studio.pointsOf("led", back).at(0).second.id);
  EXPECT_EQ(1, lost());
}

TEST_P(InBothModes, TheSameRigAgainChangesNothing) {
  Studio studio(parametersOf(GetParam()));
  studio.film(0.3, {onCircle});
  const MessageTracker::RigChange change = studio.tracker.takeRig(toMessage(studio.rig));
  EXPECT_FALSE(change.cameras);
  EXPECT_FALSE(change.correction);
  const std::uint32_t id = studio.heard.arrays.back()->points.at(0).id;
  studio.film(0.3, {onCircle});
  EXPECT_EQ(id, studio.heard.arrays.back()->points.at(0).id);
}

TEST_P(InBothModes, ANewRigTakesEffectWithTheNextImage) {
  Studio studio(parametersOf(GetParam()));
  studio.film(0.5, {onCircle});
  Rig moved = studio.rig;
  const Vector3d shift(1.0, 0.0, 0.0);
  for (geometry::RigCamera& camera : moved.cameras)
    camera.camera.world_from_camera.pretranslate(shift);
  EXPECT_TRUE(studio.tracker.takeRig(toMessage(moved)).cameras);
  const double before = studio.heard.arrays.back()->header.stamp.toSec();
  const std::size_t count = studio.heard.arrays.size();
  studio.film(1.5, {onCircle});
  for (std::size_t i = count; i < studio.heard.arrays.size(); ++i) {
    ASSERT_EQ(moved.id(), studio.heard.arrays[i]->rig_id);
    ASSERT_GT(studio.heard.arrays[i]->header.stamp.toSec(), before) << "time goes on";
  }
  const TrackedPointArray& last = *studio.heard.arrays.back();
  ASSERT_EQ(1u, last.points.size());
  const auto& p = last.points[0].position;
  EXPECT_LT((Vector3d(p.x, p.y, p.z) - onCircle(last.header.stamp.toSec()) - shift).norm(), kNear);
}

TEST_P(InBothModes, ABadRigIsRefusedAndTheOneBeforeStays) {
  Studio studio(parametersOf(GetParam()));
  RigCalibration bad = toMessage(studio.rig);
  bad.cameras[1].fx = -1.0;
  EXPECT_THROW(studio.tracker.takeRig(bad), geometry::Error);
  // A transform from a frame to itself would break TF for all nodes.
  for (const std::string& frame : {std::string("led"), std::string("camera_9_optical_frame")}) {
    TrackingParameters parameters = parametersOf(GetParam());
    parameters.labels = {"led", "camera_9_optical_frame"};
    Heard heard;
    MessageTracker tracker(parameters, &heard);
    RigCalibration conflict = toMessage(studio.rig);
    if (frame == "led")
      conflict.header.frame_id = frame;
    else
      conflict.cameras[1].name = "camera_9";
    EXPECT_THROW(tracker.takeRig(conflict), geometry::Error) << frame;
  }
  studio.film(0.5, {onCircle});
  studio.expectNear("led", 1000.3, onCircle);
}

TEST_P(InBothModes, BadImagesAreNamedOnceAndNeverInTheOutput) {
  Studio studio(parametersOf(GetParam()));
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  int turn = 0;
  // The third camera sends invalid images; the others are enough.
  studio.spoil = [&](std::size_t camera, IrBlobArray* image) {
    if (camera != 2)
      return;
    switch (turn++ % 6) {
      case 0:
        image->header.stamp = ros::Time();
        break;
      case 1:
        image->camera = "stranger";
        break;
      case 2:
        image->identity = "00:00:00:00:00:99";
        break;
      case 3:
        image->width += 1;
        break;
      case 4:
        for (auto& blob : image->blobs)
          blob.x = kNaN;
        break;
      case 5:
        for (auto& blob : image->blobs)
          blob.y = 1e9;
        break;
    }
  };
  studio.film(1.0, {onCircle});
  studio.tracker.takeImage("nobody", studio.image(0, studio.now, {onCircle}));
  for (const std::string words :
       {"carry no time", "are from stranger", "is device 00:00:00:00:00:99",
        "pixels, but it was calibrated", "outside its image"})
    EXPECT_EQ(1, studio.heard.problemsWith(words)) << words;
  EXPECT_EQ(5u, studio.heard.problems.size());
  studio.expectNear("led", 1000.5, onCircle);
  for (const auto& [time, point] : studio.pointsOf("led", 1000.5))
    ASSERT_EQ(2u, point.rays_used) << time;
}

TEST_P(InBothModes, ABagThatStartsOverResetsAll) {
  Studio studio(parametersOf(GetParam()));
  studio.film(3.0, {onCircle});
  const std::size_t count = studio.heard.arrays.size();
  studio.now = 1000.0;
  studio.film(1.0, {onCircle});
  EXPECT_EQ(1, studio.heard.problemsWith("time jumped back"));
  ASSERT_GT(studio.heard.arrays.size(), count + 200);
  // The last of these second points.
  const TrackedPointArray& last = *studio.heard.arrays.back();
  EXPECT_LT(last.header.stamp.toSec(), 1001.1);
  ASSERT_EQ(1u, last.points.size());
  EXPECT_EQ("led", last.points[0].label) << "the label is free again";
}

TEST_P(InBothModes, ZonesAreEnteredAndLeft) {
  Studio studio(parametersOf(GetParam()));
  studio.rig.zones = {{"right", {0.3, -1.0, -1.0}, {1.0, 1.0, 1.0}}};
  studio.tracker.takeRig(toMessage(studio.rig));
  studio.film(14.0, {onCircle});  // two turns
  ASSERT_GE(studio.heard.events.size(), 4u);
  std::vector<double> entered, left;
  for (const ZoneEvent& event : studio.heard.events) {
    EXPECT_EQ("right", event.zone);
    EXPECT_EQ("led", event.label);
    EXPECT_EQ("world", event.header.frame_id);
    (event.event == ZoneEvent::ENTERED ? entered : left).push_back(event.header.stamp.toSec());
    const Vector3d there(event.position.x, event.position.y, event.position.z);
    EXPECT_LT((there - onCircle(event.header.stamp.toSec())).norm(), kNear);
  }
  ASSERT_FALSE(left.empty());
  for (const double time : left)
    EXPECT_NEAR(0.3, onCircle(time).x(), kNear);
}

TEST_P(InBothModes, ATriggerGetsThePointsOfItsTime) {
  Studio studio(parametersOf(GetParam()));
  studio.film(1.0, {onCircle});
  std_msgs::Header trigger;
  trigger.stamp = ros::Time(1000, 712345678);
  studio.tracker.takeTrigger(trigger);
  ASSERT_EQ(1u, studio.heard.triggered.size()) << "its time is past";
  trigger.stamp.fromSec(studio.now + 0.5);
  studio.tracker.takeTrigger(trigger);
  EXPECT_EQ(1u, studio.heard.triggered.size()) << "no image of its time yet";
  studio.film(1.0, {onCircle});
  ASSERT_EQ(2u, studio.heard.triggered.size());
  EXPECT_EQ(ros::Time(1000, 712345678), studio.heard.triggered[0].header.stamp);
  for (const TrackedPointArray& answer : studio.heard.triggered) {
    EXPECT_EQ(studio.rig.id(), answer.rig_id);
    ASSERT_EQ(1u, answer.points.size());
    EXPECT_EQ("led", answer.points[0].label);
    const auto& p = answer.points[0].position;
    EXPECT_LT((Vector3d(p.x, p.y, p.z) - onCircle(answer.header.stamp.toSec())).norm(), kNear);
  }
  trigger.stamp = ros::Time(500);
  studio.tracker.takeTrigger(trigger);
  EXPECT_EQ(1, studio.heard.problemsWith("no points for the trigger at 500"));
  trigger.stamp.fromSec(studio.now + 1.0);
  studio.tracker.takeTrigger(trigger);
  studio.tracker.finish();
  EXPECT_EQ(2, studio.heard.problemsWith("no points for the trigger"));
  EXPECT_EQ(2u, studio.heard.triggered.size());
}

TEST_P(InBothModes, OutputAtARateKeepsEveryLoss) {
  TrackingParameters parameters = parametersOf(GetParam());
  parameters.output.on_update = false;
  parameters.output.rate = 20.0;
  Studio studio(parameters);
  studio.film(1.0, {onCircle});
  EXPECT_NEAR(20.0, static_cast<double>(studio.heard.arrays.size()), 3.0);
  studio.expectNear("led", 1000.3, onCircle);
  studio.film(5.0, {});
  const auto points = studio.pointsOf("led", 0.0);
  EXPECT_EQ(1, std::count_if(points.begin(), points.end(), [](const auto& point) {
              return point.second.state == TrackedPoint::LOST;
            }));
}

std::string bytesOf(const std::vector<TrackedPointArrayConstPtr>& arrays) {
  std::string bytes;
  for (const TrackedPointArrayConstPtr& array : arrays) {
    const auto message = ros::serialization::serializeMessage(*array);
    bytes.append(reinterpret_cast<const char*>(message.buf.get()), message.num_bytes);
  }
  return bytes;
}

TEST_P(InBothModes, TheSameMessagesGiveTheSameBytes) {
  Studio first(parametersOf(GetParam()));
  Studio second(parametersOf(GetParam()));
  first.film(0.5, {onCircle, besideCircle});
  second.film(0.5, {onCircle, besideCircle});
  ASSERT_FALSE(first.heard.arrays.empty());
  EXPECT_EQ(bytesOf(first.heard.arrays), bytesOf(second.heard.arrays));
}

/// Whether the 95 % ellipsoid holds the truth.
template <typename Covariance>
bool isInEllipsoid(const Vector3d& error, const Covariance& row_major) {
  const Eigen::Map<const Eigen::Matrix3d> covariance(row_major.data());
  return error.dot(covariance.ldlt().solve(error)) < 7.815;
}

TEST(Clocks, ACameraWithAnotherClockIsNamedOnceAndLeftOut) {
  Studio studio(parametersOf(Mode::kTracks));
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

TEST(Clocks, AnImageFromAnotherCenturyChangesNothing) {
  Studio studio(parametersOf(Mode::kTracks));
  studio.film(0.5, {onCircle});
  IrBlobArray image = studio.image(0, studio.now, {onCircle});
  image.header.stamp = image.arrival = ros::TIME_MAX;
  studio.tracker.takeImage("camera_0", image);
  studio.film(0.5, {onCircle});
  studio.expectNear("led", 1000.3, onCircle);
  EXPECT_GT(studio.pointsOf("led", 1000.5).size(), 140u);
}

TEST(Labels, ThatMayBeWrongAreNamed) {
  TrackingParameters parameters = parametersOf(Mode::kTracks);
  parameters.labels = {"led", "second"};
  Studio studio(parameters);
  const Paths paths = {onCircle, besideCircle};
  studio.film(1.0, paths);
  studio.film(20.0, {});
  EXPECT_EQ(0, studio.heard.problemsWith("given again"));
  const double again = studio.now;
  studio.film(1.0, paths);
  EXPECT_GE(studio.heard.problemsWith("given again and may be wrong"), 1);
  const auto points = studio.pointsOf("led", again);
  ASSERT_FALSE(points.empty());
  for (const auto& [time, point] : points)
    EXPECT_NEAR(0.5, point.label_confidence, 0.1) << time;
}

TEST(Identity, BlinkingLedsKeepTheirLabelsThroughDarkness) {
  constexpr double kChip = 0.023;
  const std::vector<std::string> words = {"01011111", "01010101"};
  TrackingParameters parameters = parametersOf(Mode::kTracks);
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
      const Vector3d position(point.position.x, point.position.y, point.position.z);
      const Vector3d error = position - paths[led](time);
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

}  // namespace
}  // namespace wiimote_tracker
