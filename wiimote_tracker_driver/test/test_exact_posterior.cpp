// The exact posterior of exponential delays, and smoothed frame numbers, compared with brute force.

#include "exposure_clock/exact_posterior.h"
#include "exposure_clock/frame_history.h"
#include "simulated_link.h"
#include "wiimote_tracker_driver/exposure_clock/exposure_clock.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

namespace wiimote_tracker::exposure_clock {
namespace {

constexpr double kNominal = 0.010035;
constexpr double kDriftTolerance = 6e-6;

struct Report {
  std::int64_t frame;
  double arrival;
};

std::vector<Report> exponentialReports(int frames,
                                       double spread,
                                       double period,
                                       std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::exponential_distribution<double> delay(1.0 / spread);
  std::vector<Report> reports;
  for (int k = 0; k < frames; ++k)
    reports.push_back({k, 1000.0 + k * period + delay(random)});
  return reports;
}

/// Sums over a grid of periods of all reports, with every bound.
ClockState bruteForce(const std::vector<Report>& reports, std::int64_t frame, double spread) {
  double center = 0.0;
  for (const Report& report : reports)
    center += static_cast<double>(report.frame) / static_cast<double>(reports.size());
  const double rate = static_cast<double>(reports.size()) / spread;
  constexpr int kGrid = 40000;
  std::vector<double> drift, bound, weight;
  double greatest = -1e300;
  for (int i = 0; i <= kGrid; ++i) {
    drift.push_back(kDriftTolerance * (2.0 * i / kGrid - 1.0));
    double least = 1e300;
    for (const Report& report : reports)
      least = std::min(least, report.arrival - 1000.0 -
                                  static_cast<double>(report.frame) * (kNominal + drift.back()));
    bound.push_back(least);
    weight.push_back(rate * (least + center * drift.back()));
    greatest = std::max(greatest, weight.back());
  }
  double sum = 0.0;
  ClockState mean;
  const auto n = static_cast<double>(frame);
  const auto time = [&](std::size_t i) {
    return bound[i] + n * (kNominal + drift[i]) - 1.0 / rate;
  };
  for (std::size_t i = 0; i < weight.size(); ++i) {
    weight[i] = std::exp(weight[i] - greatest);
    sum += weight[i];
    mean.time += weight[i] * time(i);
    mean.period += weight[i] * drift[i];
  }
  mean.time /= sum;
  mean.period /= sum;
  for (std::size_t i = 0; i < weight.size(); ++i) {
    const double t = time(i) - mean.time, d = drift[i] - mean.period;
    mean.p00 += weight[i] / sum * t * t;
    mean.p01 += weight[i] / sum * t * d;
    mean.p11 += weight[i] / sum * d * d;
  }
  mean.p00 += 1.0 / (rate * rate);
  mean.time += 1000.0;
  mean.period += kNominal;
  return mean;
}

TEST(ExactPosterior, is_the_posterior_mean_and_covariance) {
  int differ = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const double spread = seed % 2 ? 0.005 : 0.002;
    const auto reports = exponentialReports(700, spread, kNominal + 3e-6, seed);
    ExactPosterior posterior(kNominal, kDriftTolerance);
    // Reports ignored while it settles are ignored by brute force too.
    std::vector<Report> used;
    for (const Report& report : reports) {
      posterior.add(report.frame, report.arrival, 1.0, kNominal + 3e-6);
      if (report.frame >= 25)
        used.push_back(report);
    }
    ASSERT_TRUE(posterior.ready());
    const std::int64_t frame = 705;
    const ClockState ours = posterior.state(frame, spread);
    const ClockState truth = bruteForce(used, frame, spread);
    // Two corners of the hull in one block are rare, and then the difference is small.
    const bool same = std::abs(ours.time - truth.time) < 0.02 * std::sqrt(truth.p00) &&
                      std::abs(ours.period - truth.period) < 0.02 * std::sqrt(truth.p11) &&
                      std::abs(ours.p00 / truth.p00 - 1.0) < 0.05 &&
                      std::abs(ours.p01 / truth.p01 - 1.0) < 0.05 &&
                      std::abs(ours.p11 / truth.p11 - 1.0) < 0.05;
    differ += !same;
    EXPECT_NEAR(ours.time, truth.time, 0.5 * std::sqrt(truth.p00)) << seed;
  }
  EXPECT_LE(differ, 2);
}

TEST(ExactPosterior, with_equal_delays_it_is_the_line_itself) {
  ExactPosterior posterior(kNominal, kDriftTolerance);
  for (int k = 0; k < 5000; ++k)
    posterior.add(k, 7.0 + k * (kNominal - 2e-6), 1.0, kNominal);
  const ClockState state = posterior.state(4999, 20e-6);
  EXPECT_NEAR(state.time, 7.0 + 4999 * (kNominal - 2e-6), 1e-6);
  EXPECT_NEAR(state.period, kNominal - 2e-6, 1e-9);
  EXPECT_GT(state.p00, 0.0);
  EXPECT_GE(state.p11, 0.0);
}

TEST(ExactPosterior, forgets_what_is_older_than_its_memory) {
  ExactPosterior posterior(kNominal, kDriftTolerance);
  posterior.add(0, 5.0, 1.0, kNominal);
  for (int k = 1; k < 200; ++k)
    posterior.add(k, 5.0 + k * kNominal, 1.0, kNominal);
  for (int k = 200; k < 3000; ++k)  // the clock has jumped by 1 ms
    posterior.add(k, 5.001 + k * kNominal, 1.0, kNominal);
  EXPECT_NEAR(posterior.state(2999, 50e-6).time, 5.001 + 2999 * kNominal, 2e-6);
}

TEST(ExactPosterior, stays_precise_for_days) {
  const double period = kNominal + 3e-6;
  ExactPosterior young(kNominal, kDriftTolerance), old(kNominal, kDriftTolerance);
  for (int k = 0; k < 60; ++k)
    old.add(k, 1000.0 + k * period, 1.0, period);
  constexpr std::int64_t kDays = 100000000;  // 11 of them
  const double days = 1e8 * period;
  for (const Report& report : exponentialReports(4000, 0.005, period, 1)) {
    young.add(report.frame, report.arrival, 1.0, period);
    old.add(kDays + report.frame, days + report.arrival, 1.0, period);
  }
  const ClockState a = young.state(4000, 0.005), b = old.state(kDays + 4000, 0.005);
  EXPECT_NEAR(b.time - days, a.time, 1e-6);
  EXPECT_NEAR(b.period, a.period, 1e-10);
  EXPECT_NEAR(b.p00 / a.p00, 1.0, 0.01);
  EXPECT_NEAR(b.p01 / a.p01, 1.0, 0.01);
  EXPECT_NEAR(b.p11 / a.p11, 1.0, 0.01);
}

TEST(ExactPosterior, is_not_ready_before_it_has_seen_a_few_seconds) {
  ExactPosterior posterior(kNominal, kDriftTolerance);
  EXPECT_FALSE(posterior.ready());
  for (int k = 0; k < 400; ++k)
    posterior.add(k, k * kNominal, 1.0, kNominal);
  EXPECT_TRUE(posterior.ready());
  posterior.clear();
  EXPECT_FALSE(posterior.ready());
}

// Three reports after a certain one, each with random likelihoods of its numbers.
TEST(FrameHistory, agrees_with_the_enumeration_of_all_paths) {
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> uniform(0.001, 1.0);
  for (int trial = 0; trial < 50; ++trial) {
    constexpr int kReports = 4, kNumbers = 6;
    double likelihood[kReports][kNumbers] = {};
    FrameCounter counter;
    counter.start(0);
    FrameHistory history;
    history.add(counter, 0.0);
    for (int r = 1; r < kReports; ++r) {
      counter.predict(r == 1 ? 2 : 4);
      for (int i = 0; i < counter.size(); ++i) {
        const auto frame = static_cast<int>(counter.frame(i));
        ASSERT_LT(frame, kNumbers);
        likelihood[r][frame] = uniform(random);
        counter[i] *= likelihood[r][frame];
      }
      counter.normalise();
      history.add(counter, r);
    }
    double marginal[kReports][kNumbers] = {}, lost[kReports] = {}, kept[kReports] = {};
    for (int a = 0; a < kNumbers; ++a)
      for (int b = a; b < kNumbers; ++b)
        for (int c = b; c < kNumbers; ++c) {
          const double path = likelihood[1][a] * likelihood[2][b] * likelihood[3][c] *
                              counter.transition(a) * counter.transition(b - a) *
                              counter.transition(c - b);
          marginal[1][a] += path;
          marginal[2][b] += path;
          marginal[3][c] += path;
          const int steps[kReports] = {0, a, b - a, c - b};
          for (int r = 1; r < kReports; ++r) {
            lost[r] += steps[r] > 1 ? path : 0.0;
            kept[r] += steps[r] == 1 ? path : 0.0;
          }
        }
    ASSERT_EQ(history.smooth(counter), kReports);
    for (int r = 1; r < kReports; ++r) {
      double sum = 0.0;
      int best = 0;
      for (int k = 0; k < kNumbers; ++k) {
        sum += marginal[r][k];
        best = marginal[r][k] > marginal[r][best] ? k : best;
      }
      EXPECT_EQ(history.report(r).frame, best);
      EXPECT_NEAR(history.report(r).probability, marginal[r][best] / sum, 1e-4);
      EXPECT_NEAR(history.report(r).lost, lost[r] / sum, 1e-4);
      EXPECT_NEAR(history.report(r).kept, kept[r] / sum, 1e-4);
      EXPECT_EQ(history.report(r).arrival, r);
    }
  }
}

TEST(FrameHistory, is_complete_when_the_latest_number_is_certain_or_memory_is_full) {
  FrameHistory history;
  EXPECT_FALSE(history.complete());
  FrameCounter counter;
  counter.start(5);
  history.add(counter, 0.0);
  EXPECT_TRUE(history.complete());
  history.clear();
  int reports = 0;
  for (; !history.complete(); ++reports) {
    ASSERT_LT(reports, 1000);
    counter.predict(counter.frame(0) + 3);  // equally likely early and late, always
    counter.normalise();
    history.add(counter, reports);
  }
  EXPECT_EQ(history.smooth(counter), reports);
  history.add(counter, reports);
  EXPECT_FALSE(history.complete());
  EXPECT_EQ(history.smooth(counter), 2) << "the latest and this one";
}

// Reports whose numbers are certain at once are seldom those after losses.
TEST(FrameHistory, learns_losses_from_uncertain_frame_numbers) {
  LinkModel link;
  link.drops = 0.15;
  int reports = 0, wrong = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const SimulatedSession session = simulate(link, 20.0, seed);
    ExposureClock clock;
    for (const virtual_wiimote::FrameTime& report : session.reports) {
      const double error = clock.update(report.arrival).exposure - report.exposure - link.delay;
      if (report.exposure < link.phase + 10.0)
        continue;
      ++reports;
      wrong += std::abs(error) > 0.5 * session.period;
    }
  }
  EXPECT_LT(wrong, 0.2 * reports);
}

}  // namespace
}  // namespace wiimote_tracker::exposure_clock
