// What the Tracker panel says about LEDs, bodies and diagnostics, from messages and times.

#include "health_view.h"
#include "tracks_view.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>

namespace wiimote_tracker::panel {
namespace {

using diagnostic_msgs::DiagnosticArray;
using diagnostic_msgs::DiagnosticStatus;
using wiimote_tracker_msgs::TrackedPoint;
using wiimote_tracker_msgs::TrackedPointArray;

TrackedPointArray points(std::uint32_t number, std::uint8_t state) {
  TrackedPointArray message;
  message.header.seq = number;
  message.points.resize(1);
  TrackedPoint& led = message.points[0];
  led.label = "led";
  led.state = state;
  led.position.z = 1.5;
  led.position_covariance[0] = led.position_covariance[4] = 1e-6;
  led.position_covariance[8] = 2e-6;
  led.velocity.x = 3.0;
  led.velocity.y = 4.0;
  led.rays_used = 3;
  led.rays_possible = 4;
  return message;
}

TEST(Tracks, ShowAnLedUntilHalfASecondAfterTheLastMessage) {
  TracksView view;
  EXPECT_EQ(view.summary(10.0), "Nothing is tracked: calibrate, or check that the tracker runs.");
  view.onPoints(points(1, TrackedPoint::TRACKED), 10.0);
  const auto rows = view.leds(10.4);
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].state, "tracked");
  EXPECT_EQ(rows[0].seen_by, "3 of 4");
  EXPECT_DOUBLE_EQ(rows[0].stddev, 0.002);
  EXPECT_DOUBLE_EQ(rows[0].speed, 5.0);
  EXPECT_TRUE(view.leds(10.5).empty());
}

TEST(Tracks, ALabelThatMayBeWrongIsMarked) {
  TracksView view;
  TrackedPointArray message = points(1, TrackedPoint::TRACKED);
  for (const auto& [confidence, name] : {std::pair(0.7F, "led?"), {0.9F, "led"}, {NAN, "led"}}) {
    message.points[0].label_confidence = confidence;
    view.onPoints(message, 10.0);
    EXPECT_EQ(view.leds(10.0)[0].name, name);
  }
}

TEST(Tracks, AnLedThatWasGivenUpIsNotShown) {
  TracksView view;
  view.onPoints(points(1, TrackedPoint::LOST), 10.0);
  EXPECT_TRUE(view.leds(10.0).empty());
  EXPECT_EQ(view.summary(10.0), "No LED is seen by two cameras");
}

TEST(Tracks, AStateOfANewerTrackerIsUnknown) {
  TracksView view;
  view.onPoints(points(1, 99), 10.0);
  EXPECT_EQ(view.leds(10.0)[0].state, "unknown");
}

TEST(Tracks, CountMessagesThatWereNotHandedOver) {
  TracksView view;
  for (std::uint32_t i = 0; i <= 30; ++i)
    view.onPoints(points(27 * i, TrackedPoint::TRACKED), 10.0 + 0.1 * i);
  EXPECT_EQ(view.summary(13.0), "1 LED, 270 points/s");
}

TEST(Tracks, CountAnewWhenTheTrackerWasStartedAgain) {
  TracksView view;
  view.onPoints(points(5000, TrackedPoint::TRACKED), 9.0);
  for (std::uint32_t i = 0; i <= 11; ++i)
    view.onPoints(points(27 * i, TrackedPoint::TRACKED), 9.5 + 0.1 * i);
  EXPECT_EQ(view.summary(10.6), "1 LED, 270 points/s");
}

TEST(Tracks, ShowABodyWithItsSpeedAndTheLedsThatAreSeen) {
  TracksView view;
  wiimote_tracker_msgs::TrackedBodyArray bodies;
  bodies.bodies.resize(2);
  bodies.bodies[1].state = wiimote_tracker_msgs::TrackedBody::LOST;
  wiimote_tracker_msgs::TrackedBody& wand = bodies.bodies[0];
  wand.name = "wand";
  wand.state = wiimote_tracker_msgs::TrackedBody::PREDICTED;
  wand.pose.pose.position.y = 1.5;
  for (std::size_t i = 0; i < 36; ++i)
    wand.pose.covariance[i] = i % 7 == 0 ? 1.0 : 0.5;  // of the rotation
  wand.pose.covariance[0] = wand.pose.covariance[7] = 1e-6;
  wand.pose.covariance[14] = 2e-6;
  wand.twist.twist.linear.x = 3.0;
  wand.twist.twist.linear.z = 4.0;
  wand.leds.resize(4);
  wand.leds[1].cameras = {"wiimote_1", "wiimote_3"};
  view.onBodies(bodies, 10.0);
  const auto rows = view.bodies(10.4);
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].name, "wand");
  EXPECT_EQ(rows[0].state, "predicted");
  EXPECT_EQ(rows[0].y, 1.5);
  EXPECT_DOUBLE_EQ(rows[0].stddev, 0.002);
  EXPECT_DOUBLE_EQ(rows[0].speed, 5.0);
  EXPECT_EQ(rows[0].seen_by, "1 of 4");
  EXPECT_TRUE(view.bodies(10.5).empty());
}

TEST(Tracks, ABodyWithoutSingleLedsIsTracked) {
  TracksView view;
  view.onPoints(points(1, TrackedPoint::LOST), 10.0);
  wiimote_tracker_msgs::TrackedBodyArray bodies;
  bodies.bodies.resize(1);
  bodies.bodies[0].state = wiimote_tracker_msgs::TrackedBody::TRACKED;
  view.onBodies(bodies, 10.0);
  EXPECT_EQ(view.summary(10.0), "1 body");
  view.onPoints(points(2, TrackedPoint::TRACKED), 10.0);
  EXPECT_EQ(view.summary(10.0), "1 LED, 1 body");
}

TEST(Tracks, KeepTheLatestEvents) {
  TracksView view;
  wiimote_tracker_msgs::ZoneEvent zone;
  zone.label = "led";
  for (int i = 0; i < 7; ++i) {
    zone.zone = "room " + std::to_string(i);
    view.onZone(zone);
  }
  ASSERT_EQ(view.events().size(), TracksView::kMostEvents);
  EXPECT_EQ(view.events().front(), "led entered room 6");
}

TEST(Health, ShowsTheWorstFirstAndSaysWhoIsSilent) {
  HealthView view;
  DiagnosticArray message;
  message.status.resize(2);
  message.status[0].name = "a";
  message.status[1].name = "b";
  message.status[1].level = DiagnosticStatus::WARN;
  view.onDiagnostics(message, 10.0);
  EXPECT_EQ(view.parts(11.0).front().name, "b");
  message.status.resize(1);
  view.onDiagnostics(message, 17.0);
  const auto parts = view.parts(18.0);
  EXPECT_EQ(parts.front().level, DiagnosticStatus::STALE);
  EXPECT_EQ(parts.front().message, "says nothing for 8 s");
  EXPECT_EQ(view.parts(75.0).size(), 1u);
}

}  // namespace
}  // namespace wiimote_tracker::panel
