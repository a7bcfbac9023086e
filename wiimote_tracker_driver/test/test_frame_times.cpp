// The simulated clock and link follow their model.

#include "wiimote_tracker_driver/virtual_wiimote/frame_times.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace wiimote_tracker::virtual_wiimote {
namespace {

using Core = FrameTimesModel::Core;

/// A period so long that reports never meet.
FrameTimesModel rare() {
  FrameTimesModel model;
  model.period = 10.0;
  model.delay = 0.005;
  return model;
}

struct Moments {
  double mean = 0.0, stddev = 0.0, skewness = 0.0, least = 1e9;
};

/// Statistics of the delays of `frames` frames.
Moments delays(const FrameTimesModel& model, int frames) {
  FrameTimes times(model, 7);
  std::vector<double> all;
  Moments m;
  for (int i = 0; i < frames; ++i) {
    const FrameTime time = times.next();
    all.push_back(time.arrival - time.exposure);
    m.mean += all.back() / frames;
    m.least = std::min(m.least, all.back());
  }
  for (double d : all)
    m.stddev += (d - m.mean) * (d - m.mean) / frames;
  m.stddev = std::sqrt(m.stddev);
  for (double d : all)
    m.skewness += std::pow((d - m.mean) / m.stddev, 3) / frames;
  return m;
}

TEST(FrameTimes, an_ideal_camera_exposes_at_its_phase_and_period) {
  FrameTimesModel model;
  model.period = 0.0101;
  model.phase = 0.003;
  model.delay = 0.006;
  FrameTimes times(model, 1);
  EXPECT_EQ(times.period(), 0.0101);
  for (int i = 0; i < 1000; ++i) {
    const FrameTime time = times.next();
    ASSERT_EQ(time.frame, i);
    ASSERT_NEAR(time.exposure, 0.003 + i * 0.0101, 1e-12);
    ASSERT_NEAR(time.arrival, time.exposure + 0.006, 1e-12);
    ASSERT_FALSE(time.lost || time.queued);
  }
}

TEST(FrameTimes, equal_seeds_give_equal_times_and_other_seeds_other_times) {
  FrameTimesModel model;
  model.jitter = 0.002;
  model.period_tolerance = 500e-6;
  FrameTimes a(model, 3), b(model, 3), c(model, 4);
  EXPECT_NE(a.period(), c.period());
  for (int i = 0; i < 100; ++i)
    ASSERT_EQ(a.next().arrival, b.next().arrival);
}

TEST(FrameTimes, by_default_delays_are_exponential) {
  FrameTimesModel model = rare();
  model.jitter = 0.002;
  constexpr int kFrames = 20000;
  const Moments m = delays(model, kFrames);
  const double error = 5.0 / std::sqrt(kFrames);
  EXPECT_NEAR(m.mean, 0.007, 0.002 * error);
  EXPECT_NEAR(m.stddev, 0.002, 0.002 * std::sqrt(2.0) * error);
  EXPECT_NEAR(m.skewness, 2.0, 0.3);
  EXPECT_GE(m.least, 0.005 - 1e-9);
  EXPECT_LT(m.least, 0.005 + 5.0 * 0.002 / kFrames);
}

TEST(FrameTimes, delays_may_be_normal) {
  FrameTimesModel model = rare();
  model.core = Core::kNormal;
  model.jitter = 0.0024;
  constexpr int kFrames = 20000;
  const Moments m = delays(model, kFrames);
  const double error = 5.0 / std::sqrt(kFrames);
  EXPECT_NEAR(m.mean, 0.005 + 3.4 * 0.0024, 0.0024 * error);
  EXPECT_NEAR(m.stddev, 0.0024, 0.0024 * error);
  EXPECT_NEAR(m.skewness, 0.0, 0.1);
}

TEST(FrameTimes, periods_of_many_sessions_fill_the_tolerance) {
  FrameTimesModel model;
  model.period_tolerance = 500e-6;
  double least = 1.0, greatest = 0.0, mean = 0.0;
  for (std::uint64_t seed = 1; seed <= 1000; ++seed) {
    const double period = FrameTimes(model, seed).period();
    least = std::min(least, period);
    greatest = std::max(greatest, period);
    mean += period / 1000.0;
  }
  EXPECT_NEAR(least, 0.010035 * (1.0 - 500e-6), 0.010035 * 5e-6);
  EXPECT_NEAR(greatest, 0.010035 * (1.0 + 500e-6), 0.010035 * 5e-6);
  EXPECT_NEAR(mean, 0.010035, 0.010035 * 50e-6);
}

TEST(FrameTimes, the_phase_wanders_as_far_as_set_in_10_s) {
  FrameTimesModel model;
  model.wander = 1e-3;
  constexpr int kSessions = 400;
  double square = 0.0;
  for (std::uint64_t seed = 1; seed <= kSessions; ++seed) {
    FrameTimes times(model, seed);
    const int frames = static_cast<int>(std::lround(10.0 / times.period()));
    FrameTime time;
    for (int i = 0; i <= frames; ++i)
      time = times.next();
    const double walked = time.exposure - frames * times.period();
    square += walked * walked / kSessions;
  }
  EXPECT_NEAR(std::sqrt(square), 1e-3, 1e-3 * 5.0 / std::sqrt(2.0 * kSessions));
}

TEST(FrameTimes, losses_have_their_share_and_come_in_bursts) {
  for (double burst : {0.0, 0.5}) {
    FrameTimesModel model;
    model.drops = 0.05;
    model.burst = burst;
    FrameTimes times(model, 5);
    constexpr int kFrames = 200000;
    int lost = 0, runs = 0;
    bool before = false;
    for (int i = 0; i < kFrames; ++i) {
      const bool now = times.next().lost;
      lost += now;
      runs += now && !before;
      before = now;
    }
    EXPECT_NEAR(static_cast<double>(lost) / kFrames, 0.05, 0.004);
    EXPECT_NEAR(static_cast<double>(lost) / runs, 1.0 / (1.0 - burst), 0.1);
  }
}

TEST(FrameTimes, reports_leave_at_the_slots_and_never_overtake) {
  FrameTimesModel model;
  model.jitter = 0.03;  // far beyond the period
  model.slot = 1.25e-3;
  FrameTimes times(model, 7);
  const double first = times.next().arrival;
  double last = first;
  int queued = 0;
  for (int i = 0; i < 10000; ++i) {
    const FrameTime time = times.next();
    ASSERT_GT(time.arrival, last);
    ASSERT_GE(time.arrival, time.exposure);
    const double slots = (time.arrival - first) / 1.25e-3;
    ASSERT_NEAR(slots, std::round(slots), 1e-6);
    queued += time.queued;
    last = time.arrival;
  }
  EXPECT_GT(queued, 5000);
}

TEST(FrameTimes, a_stall_delays_all_reports_and_then_gives_them_at_once) {
  FrameTimesModel model;
  model.delay = 0.006;
  model.stalls = 0.5;
  FrameTimes times(model, 2);
  double longest = 0.0, last = 0.0;
  int stalls = 0;
  constexpr int kFrames = 100000;
  for (int i = 0; i < kFrames; ++i) {
    const FrameTime time = times.next();
    ASSERT_GE(time.arrival, last);  // in order
    const double late = time.arrival - time.exposure - 0.006;
    longest = std::max(longest, late);
    stalls += time.queued && time.arrival - last > 0.012;
    last = time.arrival;
  }
  EXPECT_GT(longest, 0.150);
  EXPECT_LT(longest, 0.320);  // a stall in a stall prolongs it
  EXPECT_GT(stalls, 300);
  EXPECT_LT(stalls, 600);
}

}  // namespace
}  // namespace wiimote_tracker::virtual_wiimote
