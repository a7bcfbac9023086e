// The clock's stamps and stated deviations against simulated links. More than 400 lines, because
// all its properties are tested with the same simulated sessions.
#include "wiimote_tracker_driver/exposure_clock/exposure_clock.h"

#include "allocation_counter.h"
#include "simulated_link.h"
#include "timing_trial.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

namespace wiimote_tracker::exposure_clock {
namespace {

constexpr double kPeriod = 0.010035;

// A true RMS r is measured from n sessions with relative standard deviation 1 / sqrt(2 n).
constexpr int kSessions = 100;
const double kTolerance = 1.0 + 3.0 / std::sqrt(2.0 * kSessions);

LinkModel exponential(double mean, double wander = 0.0) {
  LinkModel link;
  link.core = LinkModel::Core::kExponential;
  link.jitter = mean;
  link.wander = wander;
  return link;
}

LinkModel normal(double wander = 0.0) {
  LinkModel link;
  link.core = LinkModel::Core::kNormal;
  link.jitter = 0.0024;
  link.wander = wander;
  return link;
}

/// A clock that has received `reports` reports with exponential delays of mean 2 ms, none lost,
/// from time 0.
struct Running {
  explicit Running(int reports) {
    for (; frame < reports; ++frame)
      estimate = clock.update(arrival());
  }
  /// Arrival of the next frame; reports do not overtake each other.
  double arrival() { return latest = std::max(latest, time() + delay(random)); }
  /// Exposure of the next frame.
  double time() const { return frame * kPeriod; }

  std::mt19937_64 random{5};
  std::exponential_distribution<double> delay{1.0 / 0.002};
  ExposureClock clock;
  Estimate estimate;
  double latest = 0.0;
  int frame = 0;
};

TEST(ExtensiveExposureClockAccuracy, finds_the_least_of_exponential_delays_to_0_05_ms) {
  for (double mean : {0.002, 0.005}) {
    const TimingScore score = runTiming(exponential(mean), 10.0, kSessions);
    EXPECT_LT(score.clock, 0.05e-3 * kTolerance) << mean;
    EXPECT_LT(score.clock, 0.2 * score.least_squares) << mean;
    EXPECT_LT(score.clock, score.convex_hull_own) << mean;  // which has the same numbers
    // Conservative: the uncertainty about clock wander is included, and may be most of it.
    EXPECT_LT(score.clock_ratio, 1.3) << mean;
  }
}

TEST(ExtensiveExposureClockAccuracy,
     finds_exponential_delays_like_the_hull_with_known_frame_numbers) {
  const TimingScore score = runTiming(exponential(0.002), 10.0, kSessions);
  EXPECT_LT(score.clock, 1.2 * score.convex_hull);
}

TEST(ExtensiveExposureClockAccuracy, finds_normal_delays_to_0_2_ms) {
  const TimingScore score = runTiming(normal(), 10.0, kSessions);
  EXPECT_LT(score.clock, 0.2e-3 * kTolerance);
  EXPECT_LT(score.clock, 1.3 * score.least_squares);
  EXPECT_LT(score.clock, 0.3 * score.convex_hull);
  EXPECT_GT(score.clock_ratio, 0.7);
  EXPECT_LT(score.clock_ratio, 1.3);
}

TEST(ExtensiveExposureClockAccuracy, follows_a_wandering_clock_like_a_filter_that_knows_the_model) {
  for (const LinkModel& link : {normal(1e-3), exponential(0.002, 1e-3)}) {
    const TimingScore score = runTiming(link, 10.0, kSessions);
    // Same sessions on both sides: the ratio scatters less than either.
    EXPECT_LT(score.clock, 1.2 * score.oracle);
    EXPECT_LT(score.clock, score.least_squares);
    EXPECT_LT(score.clock, score.convex_hull);
    EXPECT_LT(score.clock_ratio, 1.5);
  }
}

TEST(ExtensiveExposureClockAccuracy, is_robust_to_stalls_and_slots) {
  LinkModel link = normal(0.3e-3);
  link.slot = 1.25e-3;
  link.stalls = 0.3;
  const TimingScore score = runTiming(link, 10.0, kSessions);
  EXPECT_LT(score.clock, 0.3e-3);
  EXPECT_GT(score.least_squares, 1e-3);
  EXPECT_GT(score.covered, 0.85);
}

TEST(ExtensiveExposureClockAccuracy, numbers_frames_through_losses) {
  // Lone losses show in the arrivals of 2 ms jitter at once, or one report later.
  const SimulatedSession session = simulate(exponential(0.002), 60.0, 3);
  ExposureClock clock;
  int wrong = 0;
  Estimate last;
  for (const virtual_wiimote::FrameTime& report : session.reports) {
    last = clock.update(report.arrival);
    const double error = last.exposure - report.exposure - 0.006;
    wrong += std::abs(error) > 0.5 * session.period;
  }
  const auto n = static_cast<int>(session.reports.size());
  EXPECT_LT(wrong, 0.02 * n);
  const auto frames = session.reports.back().frame - session.reports.front().frame + 1;
  EXPECT_NEAR(static_cast<double>(clock.statistics().dropped), static_cast<double>(frames - n),
              2.0);
  EXPECT_NEAR(clock.statistics().period, session.period, 5.0 * clock.statistics().period_stddev);
  EXPECT_LT(clock.statistics().period_stddev, 10e-6 * kPeriod);
}

TEST(ExtensiveExposureClockAccuracy,
     keeps_count_and_clock_over_twenty_minutes_of_losses_and_stalls) {
  LinkModel steady_exponential = exponential(0.003), wandering_normal = normal(1e-3);
  for (LinkModel link : {steady_exponential, wandering_normal}) {
    link.slot = 1.25e-3;
    link.stalls = 0.3;
    const SimulatedSession session = simulate(link, 1200.0, 77);
    ExposureClock clock;
    std::vector<double> errors;
    for (const virtual_wiimote::FrameTime& report : session.reports) {
      const double error = clock.update(report.arrival).exposure - report.exposure;
      if (report.exposure > session.reports.front().exposure + 20.0)
        errors.push_back(error - session.period * std::round(error / session.period));
    }
    double mean = 0.0, square = 0.0;
    for (double e : errors)
      mean += e / static_cast<double>(errors.size());
    for (double e : errors)
      square += (e - mean) * (e - mean) / static_cast<double>(errors.size());
    EXPECT_LT(std::sqrt(square), link.wander > 0.0 ? 0.4e-3 : 0.05e-3);
    const std::int64_t frames = session.reports.back().frame - session.reports.front().frame + 1;
    EXPECT_NEAR(static_cast<double>(clock.statistics().dropped),
                static_cast<double>(frames) - static_cast<double>(session.reports.size()), 1.0);
    EXPECT_EQ(clock.statistics().restarts, 0u);
  }
}

TEST(ExtensiveExposureClockAccuracy, a_remote_may_be_fast_or_slow) {
  for (double period : {0.00999, 0.01008})
    for (LinkModel link : {exponential(0.002), normal()}) {
      link.period = period;
      link.period_tolerance = 0.0;
      const SimulatedSession session = simulate(link, 30.0, 21);
      ExposureClock clock;
      for (const virtual_wiimote::FrameTime& report : session.reports)
        clock.update(report.arrival);
      EXPECT_NEAR(clock.statistics().period, period, 1e-6) << link.jitter;
      const std::int64_t frames = session.reports.back().frame - session.reports.front().frame + 1;
      EXPECT_NEAR(static_cast<double>(clock.statistics().dropped),
                  static_cast<double>(frames) - static_cast<double>(session.reports.size()), 2.0);
    }
}

/// Errors of a clock that receives a share of the reports from 10 to 70 s twice, out of 90 s:
/// during that time, and from `healing` seconds after it.
struct Twice {
  Twice(const LinkModel& link, double share, double later, double healing) {
    std::mt19937_64 random(3);
    std::bernoulli_distribution again(share);
    double arrival = 0.0;
    const SimulatedSession session = simulate(link, 90.0, 5);
    for (const virtual_wiimote::FrameTime& report : session.reports) {
      const double time = report.exposure - link.phase;
      const bool twice = time > 10.0 && time < 70.0 && again(random);
      extra += twice;
      for (int i = 0; i <= twice; ++i) {
        arrival = std::max(arrival, report.arrival + i * later);
        const Estimate e = clock.update(arrival);
        const double error = std::abs(e.exposure - report.exposure - link.delay);
        worst_stddev = std::max(worst_stddev, time > 10.0 ? e.stddev : 0.0);
        if (time > 10.0 && time < 70.0) {
          ++reports;
          worst = std::max(worst, error);
          wrong += error > 0.5 * session.period;
          covered += error < 2.0 * e.stddev + 0.05e-3;
        } else if (time > 70.0 + healing) {
          ++reports_after;
          wrong_after += error > 0.5 * session.period;
        }
      }
    }
    lost = session.reports.back().frame - session.reports.front().frame + 1 -
           static_cast<std::int64_t>(session.reports.size());
  }
  ExposureClock clock;
  int extra = 0, reports = 0, wrong = 0, covered = 0, reports_after = 0, wrong_after = 0;
  std::int64_t lost = 0;
  double worst = 0.0, worst_stddev = 0.0;
};

TEST(ExtensiveExposureClockAccuracy, few_reports_that_come_twice_do_no_harm) {
  for (double later : {0.0, 0.003}) {
    const Twice run(exponential(0.002), 0.01, later, 2.0);
    EXPECT_GT(run.extra, 30);
    EXPECT_LT(run.worst, 2.0 * kPeriod) << later;
    EXPECT_LT(run.worst_stddev, 2.0 * kPeriod) << later;
    EXPECT_LT(run.wrong, 0.02 * run.reports) << later;
    EXPECT_GT(run.covered, 0.97 * run.reports) << later;
    EXPECT_LT(run.wrong_after, 0.02 * run.reports_after) << later;
    EXPECT_EQ(run.clock.statistics().restarts, 0u);
    EXPECT_NEAR(static_cast<double>(run.clock.statistics().dropped),
                static_cast<double>(run.lost - run.extra), 2.0);
  }
}

// Delays learnt from an echo of 3 ms are forgotten more slowly.
TEST(ExtensiveExposureClockAccuracy, heals_after_all_reports_came_twice) {
  for (double later : {0.0, 0.003}) {
    const Twice run(exponential(0.002), 1.0, later, later > 0.0 ? 12.0 : 2.0);
    EXPECT_GT(run.clock.statistics().restarts, 0u);
    EXPECT_LT(run.worst_stddev, 0.5) << later;
    EXPECT_LT(run.wrong_after, (later > 0.0 ? 0.08 : 0.02) * run.reports_after) << later;
  }
}

TEST(ExposureClock, identifies_the_kind_and_the_size_of_the_jitter) {
  for (const LinkModel& link : {exponential(0.004), normal()}) {
    ExposureClock clock;
    for (const virtual_wiimote::FrameTime& report : simulate(link, 20.0, 7).reports)
      clock.update(report.arrival);
    const bool exponential = link.core == LinkModel::Core::kExponential;
    EXPECT_NEAR(clock.statistics().exponential, exponential ? 1.0 : 0.0, 0.01);
    EXPECT_NEAR(clock.statistics().jitter, link.jitter, 0.15 * link.jitter);
  }
}

TEST(ExposureClock, takes_normal_delays_not_for_exponential_while_they_are_equal) {
  for (const double wander : {0.0, 1e-3, 5e-3}) {
    const LinkModel link = normal(wander);
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      const SimulatedSession session = simulate(link, 30.0, seed);
      ExposureClock clock;
      for (const virtual_wiimote::FrameTime& report : session.reports)
        clock.update(report.arrival);
      double exposure = session.reports.back().exposure;
      for (int i = 0; i < 25; ++i) {
        exposure += session.period;
        const double mean = exposure + link.delay + 3.4 * link.jitter;
        const Estimate estimate = clock.update(mean);
        EXPECT_LT(std::abs(estimate.exposure - (mean - 0.0024)), 2.0 * estimate.stddev)
            << wander << ", " << seed << ", " << i;
      }
    }
  }
}

TEST(ExposureClock, is_uncertain_for_a_second_whether_delays_are_exponential) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    LinkModel link = exponential(0.0001);
    link.drops = 0.0;
    const SimulatedSession session = simulate(link, 2.0, seed);
    ExposureClock clock;
    for (const virtual_wiimote::FrameTime& report : session.reports) {
      const Estimate estimate = clock.update(report.arrival);
      const double error = std::abs(estimate.exposure - report.exposure - link.delay);
      EXPECT_LT(error, 2.0 * estimate.stddev + 0.1e-3) << seed << ", " << report.frame;
      if (report.exposure > link.phase + 1.2) {
        EXPECT_LT(error, 0.5e-3) << seed;
        EXPECT_LT(estimate.stddev, 0.5e-3) << seed;
      }
    }
  }
}

// Reports that come twice for 2 s make some of the clocks forget the kind of delays.
TEST(ExposureClock, finds_exponential_delays_as_soon_after_it_began_anew) {
  LinkModel link = exponential(0.0005);
  link.drops = 0.0;
  std::uint64_t restarts = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    ExposureClock clock;
    for (const virtual_wiimote::FrameTime& report : simulate(link, 9.0, seed).reports) {
      const double time = report.exposure - link.phase;
      const Estimate estimate = clock.update(report.arrival);
      if (time > 3.0 && time < 5.0)
        clock.update(report.arrival + 0.003);
      if (time > 6.5) {
        EXPECT_LT(std::abs(estimate.exposure - report.exposure - link.delay), 0.5e-3) << seed;
      }
    }
    restarts += clock.statistics().restarts;
  }
  EXPECT_GT(restarts, 0u);
}

TEST(ExposureClock, starts_with_the_arrival_and_a_large_stddev) {
  ExposureClock clock;
  const Estimate first = clock.update(1234.5);
  EXPECT_EQ(first.exposure, 1234.5);
  EXPECT_GE(first.stddev, 0.005);
  EXPECT_EQ(first.frame, 0);
  EXPECT_FALSE(first.stale);
  EXPECT_FALSE(first.restarted);
}

TEST(ExposureClock, stays_precise_at_times_since_1970) {
  ExposureClock small, large;
  for (const virtual_wiimote::FrameTime& report : simulate(exponential(0.002), 5.0, 11).reports) {
    const Estimate a = small.update(report.arrival), b = large.update(report.arrival + 1.7e9);
    EXPECT_NEAR(b.exposure - 1.7e9, a.exposure, 0.1e-3);
  }
}

TEST(ExposureClock, a_burst_after_a_stall_is_stale_and_gets_its_own_times) {
  Running run(500);
  const double end_of_stall = run.time() + 0.160;
  int queued = 0;
  run.latest = end_of_stall + 1e-3;
  for (; run.time() < end_of_stall; ++run.frame, ++queued) {
    const Estimate e = run.clock.update(end_of_stall + queued * 50e-6);
    const double age = end_of_stall - run.time();
    if (age > 0.045) {
      EXPECT_TRUE(e.stale) << queued;
      EXPECT_NEAR(e.exposure, run.time(), 1e-3) << queued;
    } else if (age < 0.015) {
      EXPECT_FALSE(e.stale) << queued;
    }
    EXPECT_LT(std::abs(e.exposure - run.time()), 4.0 * e.stddev + 1e-3) << queued;
  }
  EXPECT_GE(queued, 15);
  // And the clock has not moved.
  for (int i = 0; i < 20; ++i, ++run.frame)
    run.estimate = run.clock.update(run.arrival());
  EXPECT_NEAR(run.estimate.exposure + kPeriod, run.time(), 0.1e-3);
  EXPECT_GE(run.clock.statistics().stale, 10u);
}

TEST(ExposureClock, equal_arrivals_are_two_frames) {
  Running run(500);
  const Estimate first = run.clock.update(run.time() + kPeriod + 0.001);
  const Estimate second = run.clock.update(run.time() + kPeriod + 0.001);
  EXPECT_GT(second.exposure, first.exposure);
  EXPECT_NEAR(second.exposure, run.time() + kPeriod, 0.2e-3);
}

TEST(ExposureClock, frames_lost_in_a_gap_are_counted) {
  Running run(500);
  run.frame += 40;
  for (int i = 0; i < 20; ++i, ++run.frame)
    run.estimate = run.clock.update(run.arrival());
  EXPECT_NEAR(run.estimate.exposure + kPeriod, run.time(), 0.2e-3);
  EXPECT_EQ(run.clock.statistics().dropped, 40);
  EXPECT_EQ(run.clock.statistics().restarts, 0u);
}

TEST(ExposureClock, reports_in_more_than_a_second_are_followed) {
  Running run(2000);
  for (int i = 0; i < 40; ++i) {
    run.frame += 130;
    const Estimate e = run.clock.update(run.arrival());
    EXPECT_FALSE(e.restarted) << i;
    EXPECT_LT(std::abs(e.exposure - run.time()), std::min(0.005, 3.0 * e.stddev)) << i;
    ++run.frame;
  }
}

TEST(ExposureClock, a_long_gap_restarts_the_phase_and_keeps_the_period) {
  Running run(500);
  const double stddev = run.clock.statistics().period_stddev;
  const Estimate last = run.estimate;
  const Estimate e = run.clock.update(run.time() + 60.0);
  EXPECT_TRUE(e.restarted);
  EXPECT_EQ(e.exposure, run.time() + 60.0);
  EXPECT_GT(e.exposure, last.exposure);
  EXPECT_GE(e.stddev, 0.005);
  EXPECT_NEAR(static_cast<double>(e.frame - last.frame), 1.0 + 60.0 / kPeriod, 2.0);
  EXPECT_LE(run.clock.statistics().period_stddev, stddev);
}

TEST(ExposureClock, is_not_too_certain_after_long_gaps_on_a_link_of_little_jitter) {
  Running run(0);
  run.delay = std::exponential_distribution<double>(1.0 / 0.00003);
  for (int gap = 0; gap < 20; ++gap) {
    for (int i = 0; i < 1400; ++i, run.frame += i % 50 == 0 ? 2 : 1) {
      const Estimate e = run.clock.update(run.arrival());
      if (gap > 0) {
        ASSERT_LT(std::abs(e.exposure - run.time()), 4.0 * e.stddev) << gap << ' ' << i;
      }
    }
    run.frame += 600 + 37 * gap;
  }
}

TEST(ExposureClock, a_clock_that_steps_back_restarts) {
  Running run(500);
  const double step = 3600.0;
  const Estimate e = run.clock.update(run.time() - step);
  EXPECT_TRUE(e.restarted);
  EXPECT_EQ(e.exposure, run.time() - step);
  EXPECT_EQ(run.clock.statistics().restarts, 1u);
  for (int i = 0; i < 300; ++i) {
    ++run.frame;
    run.estimate = run.clock.update(run.arrival() - step);
    EXPECT_FALSE(run.estimate.restarted);
  }
  EXPECT_NEAR(run.estimate.exposure, run.time() - step, 0.5e-3);
}

TEST(ExposureClock, a_wrong_period_does_no_worse_than_a_late_stamp) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> jitter(0.0, 0.0003);
  for (double factor : {0.1, 10.0}) {
    ExposureClock clock;
    double last = 0.0;
    for (int i = 0; i < 2000; ++i) {
      const double arrival = 1.0 + i * factor * kPeriod + jitter(random);
      const Estimate e = clock.update(arrival);
      ASSERT_TRUE(std::isfinite(e.exposure) && std::isfinite(e.stddev) && e.stddev > 0.0);
      ASSERT_GT(e.exposure, last);
      ASSERT_LT(e.exposure, arrival + 0.02);
      last = e.exposure;
    }
  }
}

TEST(ExposureClock, refuses_invalid_arrivals_and_periods) {
  ExposureClock clock;
  EXPECT_THROW(clock.update(std::numeric_limits<double>::quiet_NaN()), std::invalid_argument);
  EXPECT_THROW(ExposureClock(0.0), std::invalid_argument);
}

TEST(ExposureClock, a_new_epoch_is_like_a_new_clock) {
  Running run(300);
  run.clock.reset();
  ExposureClock fresh;
  for (int i = 0; i < 50; ++i) {
    const Estimate a = run.clock.update(7.0 + i * kPeriod), b = fresh.update(7.0 + i * kPeriod);
    EXPECT_EQ(a.exposure, b.exposure);
    EXPECT_EQ(a.frame, b.frame);
  }
  EXPECT_EQ(run.clock.statistics().reports, 50u);
}

// For any arrivals, times increase, are finite, and exceed the arrival by no more than allowed.
TEST(ExposureClockProperties, hold_for_any_arrivals) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    ExposureClock clock;
    double arrival = 0.0, last = -1.0;
    for (int i = 0; i < 1000; ++i) {
      const double kind = uniform(random);
      arrival += kind < 0.2 ? 0.0 : kind < 0.95 ? 0.02 * uniform(random) : uniform(random);
      const Estimate e = clock.update(arrival);
      ASSERT_TRUE(std::isfinite(e.exposure)) << seed;
      ASSERT_GT(e.exposure, last) << seed;
      ASSERT_TRUE(e.clock_stddev > 0.0 && e.stddev >= e.clock_stddev) << seed;
      ASSERT_LT(e.exposure, arrival + 1.1 * kPeriod) << seed;
      last = e.exposure;
    }
  }
}

TEST(ExposureClockProperties, no_allocation_per_report) {
  const SimulatedSession session = simulate(exponential(0.005), 10.0, 2);
  ExposureClock clock;
  const std::uint64_t before = allocations().made;
  for (const virtual_wiimote::FrameTime& report : session.reports)
    clock.update(report.arrival);
  EXPECT_EQ(before, allocations().made);
}

}  // namespace
}  // namespace wiimote_tracker::exposure_clock
