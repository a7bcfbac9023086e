// The running node or nodelet: points in, gestures out. Whether they are marked by rests or by
// light is read from its parameter.
#include "gesture/examples_file.h"
#include "wiimote_tracker_triangulation/geometry/atomic_file.h"
#include "wiimote_tracker_triangulation/geometry/rig.h"
#include "wiimote_tracker_triangulation/ros/conversions.h"
#include "wiimote_tracker_triangulation/ros/message_fields.h"

#include <gtest/gtest.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <sensor_msgs/Joy.h>
#include <visualization_msgs/MarkerArray.h>
#include <wiimote_tracker_msgs/GestureEvent.h>
#include <wiimote_tracker_msgs/ListGestures.h>
#include <wiimote_tracker_msgs/RecordGesture.h>
#include <wiimote_tracker_msgs/RemoveGesture.h>
#include <wiimote_tracker_msgs/TrackedPointArray.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

namespace wiimote_tracker {
namespace {

using Eigen::Vector3d;
using wiimote_tracker_msgs::GestureEvent;
using wiimote_tracker_msgs::TrackedPoint;
using wiimote_tracker_msgs::TrackedPointArray;

Vector3d circle(double s) {
  return {0.2 * std::cos(2 * M_PI * s) - 0.2, 0.0, 0.2 * std::sin(2 * M_PI * s)};
}

Vector3d corner(double s) {
  return s < 0.5 ? Vector3d(0.0, 0.8 * s, 0.0) : Vector3d(0.0, 0.4, -0.8 * (s - 0.5));
}

/// Publishes drawings and collects the answers; shared by all tests, which follow each other in
/// time.
class Bench {
 public:
  Bench() {
    ros::param::get("gestures/boundary", boundary_);
    ros::param::get("gestures/file", file_);
    points_ = nh_.advertise<TrackedPointArray>("points", 1000);
    joy_ = nh_.advertise<sensor_msgs::Joy>("joy", 100);
    rig_ = nh_.advertise<wiimote_tracker_msgs::RigCalibration>("calibration/rig", 1, true);
    subscribers_ = {nh_.subscribe<GestureEvent>("gestures", 100,
                                                [this](const auto& m) { events_.push_back(*m); }),
                    nh_.subscribe<visualization_msgs::MarkerArray>(
                        "gesture_markers", 100, [this](const auto& m) { markers_.push_back(*m); })};
  }

  static bool waitFor(const std::function<bool()>& condition) {
    const ros::WallTime deadline = ros::WallTime::now() + ros::WallDuration(40.0);
    while (ros::ok() && !condition() && ros::WallTime::now() < deadline)
      ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.01));
    return condition();
  }

  bool isConnected() {
    return waitFor([&] {
      return points_.getNumSubscribers() > 0 && subscribers_[0].getNumPublishers() > 0 &&
             subscribers_[1].getNumPublishers() > 0 && rig_.getNumSubscribers() > 0 &&
             (boundary_ != "button" || joy_.getNumSubscribers() > 0);
    });
  }

  void publishZones(const std::vector<geometry::Zone>& zones) {
    geometry::Rig rig;
    rig.cameras.resize(1);
    rig.cameras[0].camera.name = "camera";
    rig.zones = zones;
    rig_.publish(toMessage(rig));
  }

  void publish(const Vector3d* position) {
    TrackedPointArray array;
    array.header.stamp.fromSec(time_);
    array.header.frame_id = "world";
    if (position) {
      TrackedPoint point;
      point.id = id_;
      point.label = "led";
      point.state = TrackedPoint::TRACKED;
      point.last_observed = array.header.stamp;
      point.position = pointOf(*position);
      array.points.push_back(point);
    }
    points_.publish(array);
    time_ += 0.01;
    // The node keeps the newest 200 arrays while it stands still.
    if (++published_ % 50 == 0)
      list();  // its answer shows that the node goes on
  }

  /// A thousand other LEDs, at another time.
  void publishStrangers(double seconds_ahead) {
    TrackedPointArray array;
    array.header.stamp.fromSec(time_ + seconds_ahead);
    TrackedPoint point;
    point.state = TrackedPoint::TRACKED;
    for (point.id = 1000; point.id < 2000; ++point.id)
      array.points.push_back(point);
    points_.publish(array);
  }

  void publishButton(double time, bool pressed) {
    sensor_msgs::Joy joy;
    joy.header.stamp.fromSec(time);
    joy.buttons = {0, 0, pressed};
    joy_.publish(joy);
  }

  /// The button is held for the next second; its release is published early.
  void holdButton() {
    publishButton(time_, true);
    publishButton(time_ + 1.005, false);
    list();  // its answer shows that the button events have arrived
  }

  /// A gesture with its boundaries, 1 s long.
  void draw(const std::function<Vector3d(double)>& curve, const Vector3d& place) {
    const bool rests = boundary_ != "light";
    const auto at = [&](double s) { return Vector3d(place + curve(s)); };
    begin_ = time_ + (rests ? 0.5 : 0.0);
    for (int i = rests ? -50 : 0; i <= (rests ? 150 : 100); ++i) {
      if (i == 0 && boundary_ == "button")
        holdButton();
      const Vector3d position = at(std::min(std::max(0.01 * i, 0.0), 1.0));
      publish(&position);
    }
    for (int i = 0; i < 40; ++i)
      publish(nullptr);
    ++id_;
  }

  /// The next event; nothing marked by `event` == 255 when none came.
  GestureEvent nextEvent() {
    waitFor([&] { return events_.size() > taken_; });
    GestureEvent none;
    none.event = 255;
    return events_.size() > taken_ ? events_[taken_++] : none;
  }

  template <typename Service>
  typename Service::Response call(const std::string& name,
                                  const typename Service::Request& request) {
    Service service;
    service.request = request;
    EXPECT_TRUE(ros::service::waitForService(name, 40000));
    EXPECT_TRUE(ros::service::call(name, service));
    return service.response;
  }

  std::string record(const std::string& gesture, const std::string& zone = "") {
    wiimote_tracker_msgs::RecordGesture::Request request;
    request.gesture = gesture;
    request.zone = zone;
    const auto response = call<wiimote_tracker_msgs::RecordGesture>("gestures/record", request);
    return response.success ? "" : response.message;
  }

  bool remove(const std::string& gesture) {
    wiimote_tracker_msgs::RemoveGesture::Request request;
    request.gesture = gesture;
    return call<wiimote_tracker_msgs::RemoveGesture>("gestures/remove", request).success;
  }

  wiimote_tracker_msgs::ListGestures::Response list() {
    return call<wiimote_tracker_msgs::ListGestures>("gestures/list", {});
  }

  std::string boundary_;
  std::string file_;
  std::vector<GestureEvent> events_;
  std::vector<visualization_msgs::MarkerArray> markers_;
  double begin_ = 0.0;  // of the gesture drawn last
  double time_ = 1000.0;
  std::uint32_t id_ = 0;

 private:
  ros::NodeHandle nh_;
  ros::Publisher points_;
  ros::Publisher joy_;
  ros::Publisher rig_;
  std::vector<ros::Subscriber> subscribers_;
  std::size_t published_ = 0;
  std::size_t taken_ = 0;
};

class GesturesTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    bench_ = new Bench;
    ASSERT_TRUE(bench_->isConnected());
  }
  static void TearDownTestSuite() {
    delete bench_;
    bench_ = nullptr;
  }

  static void recordCircle() {
    ASSERT_EQ(bench_->record("circle"), "");
    bench_->draw(circle, {0.0, 0.0, 1.0});
    ASSERT_EQ(bench_->nextEvent().event, GestureEvent::RECORDED);
  }

  static Bench* bench_;
};

Bench* GesturesTest::bench_ = nullptr;

TEST_F(GesturesTest, AreRecordedRecognisedRejectedAndRemoved) {
  ASSERT_EQ(bench_->record("circle"), "");
  bench_->draw(circle, {0.0, 0.0, 1.0});
  const GestureEvent recorded = bench_->nextEvent();
  ASSERT_EQ(recorded.event, GestureEvent::RECORDED);
  EXPECT_EQ(recorded.gesture, "circle");
  ASSERT_EQ(bench_->record("corner"), "");
  bench_->draw(corner, {0.0, 0.0, 1.0});
  ASSERT_EQ(bench_->nextEvent().event, GestureEvent::RECORDED);

  const auto known = bench_->list();
  EXPECT_EQ(known.gestures, (std::vector<std::string>{"circle", "corner"}));
  EXPECT_EQ(known.examples, (std::vector<std::uint32_t>{1, 1}));
  EXPECT_EQ(gesture::readExamples(bench_->file_).size(), 2u);

  bench_->draw([](double s) { return Vector3d(1.6 * circle(s)); }, {2.0, 1.0, 0.5});
  const GestureEvent found = bench_->nextEvent();
  EXPECT_EQ(found.event, GestureEvent::RECOGNISED);
  EXPECT_EQ(found.gesture, "circle");
  EXPECT_GT(found.score, 0.9);
  EXPECT_EQ(found.runner_up, "corner");
  EXPECT_LT(found.runner_up_score, 0.5);
  EXPECT_EQ(found.label, "led");
  EXPECT_EQ(found.header.frame_id, "world");
  EXPECT_NEAR(found.begin.toSec(), bench_->begin_, 0.3);
  EXPECT_NEAR(found.end.toSec(), bench_->begin_ + 1.0, 0.1);
  EXPECT_NEAR(found.minimum.x, 2.0 - 0.64, 0.02);
  EXPECT_NEAR(found.maximum.x, 2.0, 0.02);
  EXPECT_NEAR(found.maximum.z - found.minimum.z, 0.64, 0.02);

  bench_->draw([](double s) { return corner(1.0 - s); }, {0.0, 0.0, 1.0});
  EXPECT_EQ(bench_->nextEvent().event, GestureEvent::REJECTED);

  EXPECT_TRUE(Bench::waitFor([&] { return bench_->markers_.size() >= 4; }));
  EXPECT_EQ(bench_->markers_[2].markers.at(1).text, "circle");

  EXPECT_TRUE(bench_->remove("circle"));
  EXPECT_FALSE(bench_->remove("circle"));
  bench_->draw(circle, {0.0, 0.0, 1.0});
  EXPECT_EQ(bench_->nextEvent().event, GestureEvent::REJECTED);
  EXPECT_TRUE(bench_->remove("corner"));
  EXPECT_TRUE(bench_->list().gestures.empty());
}

TEST_F(GesturesTest, ZonesHaveTheirOwn) {
  bench_->publishZones({{"kitchen", {0.0, -2.0, 0.0}, {4.0, 2.0, 3.0}},
                        {"studio", {10.0, -2.0, 0.0}, {14.0, 2.0, 3.0}}});
  ASSERT_TRUE(Bench::waitFor([&] { return bench_->record("lights", "kitchen").empty(); }));
  EXPECT_NE(bench_->record("lights", "cellar"), "");
  EXPECT_NE(bench_->record("smile:]"), "") << "the file could not be read again";
  for (const std::string& name : {std::string("two\nlines"), std::string(300, 'a')})
    EXPECT_NE(bench_->record(name).find("a gesture's name must"), std::string::npos) << name;
  bench_->draw(circle, {2.0, 0.0, 1.0});
  EXPECT_EQ(bench_->nextEvent().event, GestureEvent::RECORDED);
  bench_->draw(circle, {12.0, 0.0, 1.0});
  bench_->draw(circle, {2.0, 0.0, 1.0});
  // The studio has no gestures, so none is reported.
  const GestureEvent event = bench_->nextEvent();
  EXPECT_EQ(event.event, GestureEvent::RECOGNISED);
  EXPECT_EQ(event.zone, "kitchen");
  EXPECT_NEAR(event.end.toSec(), bench_->begin_ + 1.0, 0.1);
  EXPECT_EQ(bench_->list().zones, (std::vector<std::string>{"kitchen"}));
  EXPECT_TRUE(bench_->remove("lights"));
}

TEST_F(GesturesTest, AreNotWrittenOverAFileThatAPersonChanged) {
  ASSERT_NO_FATAL_FAILURE(recordCircle());
  const std::string content = geometry::readFile(bench_->file_);
  std::ofstream(bench_->file_) << content << "# by hand\n";
  EXPECT_NE(bench_->record("corner").find("was changed after it was read"), std::string::npos);
  EXPECT_FALSE(bench_->remove("circle"));
  std::ofstream(bench_->file_) << content;
  EXPECT_TRUE(bench_->remove("circle"));
}

TEST_F(GesturesTest, GoOnAfterABagStartsOver) {
  ASSERT_NO_FATAL_FAILURE(recordCircle());
  bench_->time_ = 500.0;
  bench_->draw(circle, {0.0, 0.0, 1.0});
  EXPECT_EQ(bench_->nextEvent().event, GestureEvent::RECOGNISED);
  EXPECT_TRUE(bench_->remove("circle"));
}

TEST_F(GesturesTest, GoOnAfterTheButtonWasHeldWhereABagStartsOver) {
  ASSERT_NO_FATAL_FAILURE(recordCircle());
  bench_->publishButton(bench_->time_, true);
  bench_->list();  // its answer shows that the button event has arrived
  bench_->time_ -= 20.0;
  bench_->draw(circle, {0.0, 0.0, 1.0});
  EXPECT_EQ(bench_->nextEvent().event, GestureEvent::RECOGNISED);
  EXPECT_TRUE(bench_->remove("circle"));
}

TEST_F(GesturesTest, GoOnWhileAnotherProgramPublishesPoints) {
  ASSERT_NO_FATAL_FAILURE(recordCircle());
  int drawn = 0;
  bench_->draw(
      [&](double s) {
        if (++drawn % 20 == 0)
          bench_->publishStrangers(drawn % 40 == 0 ? 1000.0 : -400.0);
        return circle(s);
      },
      {0.0, 0.0, 1.0});
  EXPECT_EQ(bench_->nextEvent().event, GestureEvent::RECOGNISED);
  EXPECT_TRUE(bench_->remove("circle"));
}

struct ContinuousGesturesTest : GesturesTest {
  static void trace(const std::function<Vector3d(double)>& curve, const Vector3d& place) {
    for (int i = 0; i < 100; ++i) {
      const Vector3d position = place + curve(0.01 * i);
      bench_->publish(&position);
    }
  }
};

TEST_F(ContinuousGesturesTest, BelongToTheZoneOfTheirMiddle) {
  bench_->publishZones({{"kitchen", {1.5, -2.0, 0.0}, {1.66, 2.0, 3.0}}});
  ASSERT_TRUE(Bench::waitFor([&] { return bench_->record("lights", "kitchen").empty(); }));
  bench_->draw(circle, {2.0, 0.0, 1.0});
  EXPECT_EQ(bench_->nextEvent().event, GestureEvent::RECORDED);
  trace(circle, {2.0, 0.0, 1.0});
  for (int i = 0; i < 40; ++i)
    bench_->publish(nullptr);
  EXPECT_EQ(bench_->nextEvent().zone, "kitchen");
  EXPECT_TRUE(bench_->remove("lights"));
}

TEST_F(ContinuousGesturesTest, AreFoundInContinuousMotion) {
  ASSERT_NO_FATAL_FAILURE(recordCircle());
  const auto straight = [](double s) { return Vector3d(0.5 * s, 0.3 * s, -0.2 * s); };
  trace(straight, {0.0, 0.0, 1.0});
  const double begin = bench_->time_;
  trace(circle, {0.5, 0.3, 0.8});
  trace(straight, {0.5, 0.3, 0.8});
  const GestureEvent found = bench_->nextEvent();
  EXPECT_EQ(found.event, GestureEvent::RECOGNISED);
  EXPECT_EQ(found.gesture, "circle");
  EXPECT_GE(found.score, 0.7);
  EXPECT_NEAR(found.begin.toSec(), begin, 0.2);
  EXPECT_NEAR(found.end.toSec(), begin + 1.0, 0.2);
  // It is reported although the light goes out right after it.
  trace(circle, {1.0, 0.6, 0.6});
  for (int i = 0; i < 40; ++i)
    bench_->publish(nullptr);
  const GestureEvent last = bench_->nextEvent();
  EXPECT_EQ(last.gesture, "circle");
  EXPECT_NEAR(last.end.toSec(), bench_->time_ - 0.4, 0.2);
}

/// Its node has a file of examples and a minimum_length above theirs.
class RaisedMinimumLengthTest : public GesturesTest {};

TEST_F(RaisedMinimumLengthTest, UsesShorterExamples) {
  EXPECT_FALSE(bench_->list().gestures.empty());
}

}  // namespace
}  // namespace wiimote_tracker
