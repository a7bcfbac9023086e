// Positions at irregular times become positions at one rate.
#include "refusal_of.h"
#include "ros/measurements/sample_table.h"
#include "wiimote_tracker_triangulation/geometry/error.h"
#include "wiimote_tracker_triangulation/ros/message_fields.h"

#include <gtest/gtest.h>

#include <string>

namespace wiimote_tracker::measurements {
namespace {

using Eigen::Vector3d;
using wiimote_tracker_msgs::TrackedPoint;
using wiimote_tracker_msgs::TrackedPointArray;

constexpr std::int64_t kStart = 1700000000000000000;
constexpr double kRate = 100.0;

TrackedPointArray at(double seconds, const std::string& label, double x) {
  TrackedPointArray message;
  message.header.stamp.fromNSec(
      static_cast<std::uint64_t>(kStart + static_cast<std::int64_t>(1e9 * seconds)));
  message.points.resize(1);
  message.points[0].label = label;
  message.points[0].state = TrackedPoint::TRACKED;
  setVector(Vector3d(x, 2.0 * x, -x), &message.points[0].position);
  return message;
}

void add(const TrackedPointArray& message, SampleTable* table, bool triggered = false) {
  table->add({message, message.points[0], triggered});
}

TEST(SampleTable, InterpolatesBetweenNeighbours) {
  SampleTable table;
  for (const double t : {0.0, 0.003, 0.017, 0.029, 0.041})
    add(at(t, "led", 10.0 * t), &table);
  const Samples samples = table.resample(kRate);
  EXPECT_EQ(samples.start, kStart);
  EXPECT_EQ(samples.frames, 5u);
  ASSERT_EQ(samples.labels, std::vector<std::string>{"led"});
  for (std::size_t i = 0; i < samples.frames; ++i)
    EXPECT_LT((samples.positions[0][i] - 0.1 * static_cast<double>(i) * Vector3d(1, 2, -1)).norm(),
              1e-12)
        << i;
}

TEST(SampleTable, LongGapsAndTheEndsStayOpen) {
  SampleTable table;
  for (const double t : {0.0, 0.01, 0.10, 0.11, 0.14})
    add(at(t, "gap", 1.0), &table);
  add(at(0.2, "late", 1.0), &table);
  const Samples samples = table.resample(kRate);
  ASSERT_EQ(samples.frames, 21u);
  for (std::size_t i = 0; i < samples.frames; ++i) {
    const bool is_known = i <= 1 || (i >= 10 && i <= 14);
    EXPECT_EQ(samples.positions[0][i].allFinite(), is_known) << i;
    EXPECT_EQ(samples.positions[1][i].allFinite(), i == 20) << i;
  }
}

TEST(SampleTable, RefusesTimesAYearApart) {
  SampleTable table;
  add(at(0.0, "led", 1.0), &table);
  add(at(365.0 * 86400.0, "led", 1.0), &table);
  EXPECT_THROW(table.resample(kRate), Error);
  EXPECT_EQ(table.resample(0.1).frames, 3153601u);
}

TEST(SampleTable, RefusesADayOfManyReflections) {
  SampleTable table;
  for (int i = 0; i < 1000; ++i)
    add(at(86.4 * i, "led_" + std::to_string(i), 1.0), &table);
  const std::string refusal = refusalOf([&] { table.resample(kRate); });
  EXPECT_NE(refusal.find("and has 1000 LEDs"), std::string::npos) << refusal;
  EXPECT_NE(refusal.find("mask reflections"), std::string::npos) << refusal;
  EXPECT_EQ(table.resample(0.01).labels.size(), 1000u);
}

TEST(SampleTable, BridgesOneAndAHalfFramesOfALowRate) {
  SampleTable table;
  for (const double t : {0.0, 0.14, 0.30})
    add(at(t, "led", 10.0 * t), &table);
  const Samples samples = table.resample(10.0);
  ASSERT_EQ(samples.frames, 4u);
  EXPECT_NEAR(samples.positions[0][1].x(), 1.0, 1e-6);
  EXPECT_FALSE(samples.positions[0][2].allFinite()) << "0.16 s are too long";
  EXPECT_EQ(samples.positions[0][3].x(), 3.0);
}

TEST(SampleTable, TakesOnlyTrackedLedsAndSortsThem) {
  SampleTable table;
  add(at(0.01, "led", 1.0), &table);
  add(at(0.0, "led", 0.0), &table);  // time jumped back
  TrackedPointArray predicted = at(0.5, "led", 9.0);
  predicted.points[0].state = TrackedPoint::PREDICTED;
  add(predicted, &table);
  add(at(0.6, "led", 9.0), &table, true);
  const Samples samples = table.resample(kRate);
  ASSERT_EQ(samples.frames, 2u);
  EXPECT_EQ(samples.positions[0][1].x(), 1.0);
  EXPECT_EQ(SampleTable().resample(kRate).frames, 0u);
}

TEST(SampleTable, LedsOfTrackedBodiesComeAfterTheOthers) {
  SampleTable table;
  wiimote_tracker_msgs::TrackedBodyArray message;
  message.bodies.resize(2);
  for (wiimote_tracker_msgs::TrackedBody& body : message.bodies) {
    body.name = "arm";
    body.state = wiimote_tracker_msgs::TrackedBody::TRACKED;
    body.leds.resize(2);
    body.leds[0].label = "left";
    body.leds[1].label = "1";
    setVector(Vector3d(1.0, 2.0, 3.0), &body.leds[0].position);
  }
  message.bodies[1].name = "hidden";
  message.bodies[1].state = wiimote_tracker_msgs::TrackedBody::PREDICTED;
  message.header.stamp.fromNSec(kStart - 10000000);
  table.addBodies(message);
  add(at(0.0, "led", 1.0), &table);
  const Samples samples = table.resample(kRate);
  EXPECT_EQ(samples.labels, (std::vector<std::string>{"led", "arm:1", "arm:left"}));
  EXPECT_EQ(samples.start, kStart - 10000000);
  ASSERT_EQ(samples.frames, 2u);
  EXPECT_EQ(samples.positions[2][0], Vector3d(1.0, 2.0, 3.0));
  EXPECT_FALSE(samples.positions[2][1].allFinite());
  EXPECT_EQ(samples.positions[0][1].x(), 1.0);
}

}  // namespace
}  // namespace wiimote_tracker::measurements
