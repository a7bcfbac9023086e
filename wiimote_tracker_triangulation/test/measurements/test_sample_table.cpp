// Positions at irregular times become positions at one rate.
#include "measurements/sample_table.h"

#include <gtest/gtest.h>

#include <string>

namespace wiimote_tracker::measurements {
namespace {

using Eigen::Vector3d;

constexpr std::int64_t kStart = 1700000000000000000;
constexpr double kRate = 100.0;

Measurement at(double seconds, const std::string& label, double x) {
  Measurement m;
  m.stamp = kStart + static_cast<std::int64_t>(1e9 * seconds);
  m.label = label;
  m.state = "tracked";
  m.position = Vector3d(x, 2.0 * x, -x);
  return m;
}

TEST(SampleTable, InterpolatesBetweenNeighbours) {
  SampleTable table;
  for (const double t : {0.0, 0.003, 0.017, 0.029, 0.041})
    table.add(at(t, "led", 10.0 * t));
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
    table.add(at(t, "gap", 1.0));
  table.add(at(0.2, "late", 1.0));
  const Samples samples = table.resample(kRate);
  ASSERT_EQ(samples.frames, 21u);
  for (std::size_t i = 0; i < samples.frames; ++i) {
    const bool is_known = i <= 1 || (i >= 10 && i <= 14);
    EXPECT_EQ(samples.positions[0][i].allFinite(), is_known) << i;
    EXPECT_EQ(samples.positions[1][i].allFinite(), i == 20) << i;
  }
}

TEST(SampleTable, BridgesOneAndAHalfFramesOfALowRate) {
  SampleTable table;
  for (const double t : {0.0, 0.14, 0.30})
    table.add(at(t, "led", 10.0 * t));
  const Samples samples = table.resample(10.0);
  ASSERT_EQ(samples.frames, 4u);
  EXPECT_NEAR(samples.positions[0][1].x(), 1.0, 1e-6);
  EXPECT_FALSE(samples.positions[0][2].allFinite()) << "0.16 s are too long";
  EXPECT_EQ(samples.positions[0][3].x(), 3.0);
}

TEST(SampleTable, TakesOnlyTrackedLedsAndSortsThem) {
  SampleTable table;
  table.add(at(0.01, "led", 1.0));
  table.add(at(0.0, "led", 0.0));  // time jumped back
  Measurement predicted = at(0.5, "led", 9.0);
  predicted.state = "predicted";
  table.add(predicted);
  Measurement triggered = at(0.6, "led", 9.0);
  triggered.triggered = true;
  table.add(triggered);
  const Samples samples = table.resample(kRate);
  ASSERT_EQ(samples.frames, 2u);
  EXPECT_EQ(samples.positions[0][1].x(), 1.0);
  EXPECT_EQ(SampleTable().resample(kRate).frames, 0u);
}

}  // namespace
}  // namespace wiimote_tracker::measurements
