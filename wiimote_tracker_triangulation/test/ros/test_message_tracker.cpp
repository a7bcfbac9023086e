// The code that node and track_bag share, in both modes: messages in, messages out.
#include "ros/studio.h"
#include "wiimote_tracker_triangulation/geometry/error.h"

#include <gtest/gtest.h>
#include <ros/serialization.h>

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

namespace wiimote_tracker {
namespace {

using namespace studio;
using wiimote_tracker_msgs::RigCalibration;

class InBothModes : public testing::TestWithParam<TrackerMode> {};

INSTANTIATE_TEST_SUITE_P(MessageTracker,
                         InBothModes,
                         testing::Values(TrackerMode::kTracks, TrackerMode::kInstant),
                         [](const auto& info) {
                           return info.param == TrackerMode::kTracks ? "Tracks" : "Instant";
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
  EXPECT_EQ(GetParam() == TrackerMode::kTracks ? "track" : "maximum_likelihood", last.method);
  EXPECT_EQ(2u, last.points.size());
  EXPECT_EQ(3u, studio.heard.view_count);
  EXPECT_TRUE(studio.heard.problems.empty());

  EXPECT_EQ(0u, last.late_frames);
  studio.tracker.takeImage("camera_0", studio.image(0, studio.now - 0.045, {onCircle}));
  studio.film(0.1, {onCircle});
  EXPECT_EQ(1u, studio.heard.arrays.back()->late_frames);
}

TEST_P(InBothModes, ARangeThatExcludesTheRoomIsReported) {
  TrackingParameters parameters = parametersOf(GetParam());
  parameters.estimator.tracks.maximum_range = parameters.estimator.instant.maximum_range = 0.2;
  Studio studio(parameters);
  EXPECT_EQ(1, studio.heard.problemsWith("/maximum_range, 0.2 m, so no LED is tracked"));
  studio.film(1.0, {onCircle});
  EXPECT_TRUE(studio.heard.arrays.back()->points.empty());
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
  EXPECT_FALSE(change.points);
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
  EXPECT_TRUE(studio.tracker.takeRig(toMessage(moved)).points);
  const double before = studio.heard.arrays.back()->header.stamp.toSec();
  const std::size_t count = studio.heard.arrays.size();
  studio.film(1.5, {onCircle});
  for (std::size_t i = count; i < studio.heard.arrays.size(); ++i) {
    ASSERT_EQ(moved.id(), studio.heard.arrays[i]->rig_id);
    ASSERT_GT(studio.heard.arrays[i]->header.stamp.toSec(), before) << "time goes on";
  }
  const TrackedPointArray& last = *studio.heard.arrays.back();
  ASSERT_EQ(1u, last.points.size());
  const Vector3d found = vectorOf(last.points[0].position);
  EXPECT_LT((found - onCircle(last.header.stamp.toSec()) - shift).norm(), kNear);
}

/// Camera 2 sees nothing. The rig names the cameras in another order from the middle on.
TEST_P(InBothModes, PointsNameTheCamerasOfTheirOwnRig) {
  TrackingParameters parameters = parametersOf(GetParam());
  parameters.output.on_update = false;
  parameters.output.rate = 20.0;
  Studio studio(parameters);
  studio.spoil = [](std::size_t camera, IrBlobArray* image) {
    if (camera == 2)
      image->blobs.clear();
  };
  studio.film(1.0, {onCircle});
  Rig turned = studio.rig;
  std::reverse(turned.cameras.begin(), turned.cameras.end());
  studio.tracker.takeRig(toMessage(turned));
  std_msgs::Header trigger;
  trigger.stamp.fromSec(studio.now - 0.5);
  studio.tracker.takeTrigger(trigger);
  studio.film(1.0, {onCircle});
  std::size_t seen = 0;
  for (const auto& [time, point] : studio.pointsOf("led", 1000.3)) {
    for (const std::string& camera : point.cameras)
      EXPECT_NE("camera_2", camera) << time;
    seen += point.cameras.size();
  }
  EXPECT_GT(seen, 40u);
  EXPECT_TRUE(studio.heard.triggered.empty()) << "its snapshots are of the rig before";
  EXPECT_EQ(1, studio.heard.problemsWith("no points for the trigger"));
}

TEST_P(InBothModes, AnIntervalOfTheOutputThinsOutPointsOnly) {
  TrackingParameters parameters = parametersOf(GetParam());
  parameters.output.interval = 0.1;
  Studio studio(parameters);
  studio.film(1.0, {onCircle});
  const auto& arrays = studio.heard.arrays;
  ASSERT_GE(arrays.size(), 8u);
  for (std::size_t i = 1; i < arrays.size(); ++i)
    EXPECT_GE((arrays[i]->header.stamp - arrays[i - 1]->header.stamp).toSec(), 0.1 - 1e-6);
  std_msgs::Header trigger;
  trigger.stamp.fromSec(studio.now - 0.055);
  studio.tracker.takeTrigger(trigger);
  EXPECT_EQ(1u, studio.heard.triggered.size());
}

TEST_P(InBothModes, ABadRigIsRefusedAndTheOneBeforeStays) {
  Studio studio(parametersOf(GetParam()));
  RigCalibration bad = toMessage(studio.rig);
  bad.cameras[1].fx = -1.0;
  EXPECT_THROW(studio.tracker.takeRig(bad), geometry::Error);
  // A transform from a frame to itself would break TF for all nodes.
  RigCalibration other = toMessage(studio.rig);
  other.header.frame_id = "lab";
  other.cameras[1].name = "camera_9";
  EXPECT_NO_THROW(Studio(parametersOf(GetParam())).tracker.takeRig(other));
  for (const char* frame : {"lab", "lab_square", "camera_9_optical_frame", "camera_9_imu_frame"}) {
    TrackingParameters parameters = parametersOf(GetParam());
    parameters.labels = {"led", frame};
    EXPECT_THROW(Studio(parameters).tracker.takeRig(other), geometry::Error) << frame;
  }
  for (const std::string& frame : studio.rig.frames()) {
    Heard heard;
    MessageTracker tracker(parametersOf(GetParam()), &heard);
    const body::Constellation body{frame, {{0.0, 0.0, 0.0}, {0.1, 0.0, 0.0}, {0.0, 0.2, 0.0}}};
    tracker.setBodies({body});
    EXPECT_THROW(tracker.takeRig(toMessage(studio.rig)), geometry::Error) << "body " << frame;
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

TEST_P(InBothModes, ABagThatStartsOverEmptiesItsZonesAndHasItsOwnTriggers) {
  Studio studio(parametersOf(GetParam()));
  studio.rig.zones = {{"room", {-2.0, -2.0, -2.0}, {2.0, 2.0, 2.0}}};
  studio.tracker.takeRig(toMessage(studio.rig));
  studio.film(3.0, {onCircle});
  const auto count = [&](std::uint8_t event) {
    return std::count_if(studio.heard.events.begin(), studio.heard.events.end(),
                         [&](const ZoneEvent& e) { return e.event == event; });
  };
  EXPECT_EQ(0, count(ZoneEvent::LEFT));
  studio.now = 1000.0;
  studio.film(1.0, {onCircle});
  EXPECT_EQ(1, count(ZoneEvent::LEFT));
  EXPECT_EQ(2, count(ZoneEvent::ENTERED));
  EXPECT_LT(studio.heard.events.back().header.stamp.toSec(), 1001.0);

  std_msgs::Header trigger;
  trigger.stamp.fromSec(1000.5);
  studio.tracker.takeTrigger(trigger);
  ASSERT_EQ(1u, studio.heard.triggered.size());
  ASSERT_EQ(1u, studio.heard.triggered[0].points.size());
  trigger.stamp.fromSec(1002.0);
  studio.tracker.takeTrigger(trigger);
  EXPECT_EQ(1u, studio.heard.triggered.size()) << "the snapshots of before are forgotten";
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
    EXPECT_LT((vectorOf(event.position) - onCircle(event.header.stamp.toSec())).norm(), kNear);
  }
  ASSERT_FALSE(entered.empty());
  ASSERT_FALSE(left.empty());
  for (const auto& times : {entered, left}) {
    for (const double time : times)
      EXPECT_NEAR(0.3, onCircle(time).x(), kNear);
  }
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
    const Vector3d found = vectorOf(answer.points[0].position);
    EXPECT_LT((found - onCircle(answer.header.stamp.toSec())).norm(), kNear);
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

}  // namespace
}  // namespace wiimote_tracker
