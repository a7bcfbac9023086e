#include "timing_trial.h"

#include "reference_clocks.h"
#include "wiimote_tracker_driver/exposure_clock/exposure_clock.h"

#include <cmath>
#include <ctime>
#include <numeric>

namespace wiimote_tracker::exposure_clock {

namespace {
double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}
double rmsAboutMean(const std::vector<double>& values) {
  const double m = mean(values);
  double sum = 0.0;
  for (double v : values)
    sum += (v - m) * (v - m);
  return std::sqrt(sum / (static_cast<double>(values.size()) - 1.0));
}
}  // namespace

TimingScore runTiming(const LinkModel& link,
                      double duration,
                      int sessions,
                      bool blind_oracle,
                      std::uint64_t first_seed) {
  std::vector<double> arrival, squares, hull, olsons, own_squares, own_hull, best, blind, clock,
      total, clock_stddev, stddev;
  double seconds = 0.0;
  std::size_t reports = 0;
  int wrong = 0, blind_wrong = 0;
  for (int i = 0; i < sessions; ++i) {
    const SimulatedSession session =
        simulate(link, duration, first_seed + static_cast<std::uint64_t>(i));
    ExposureClock ours;
    Estimate estimate;
    SimulatedSession numbered = session;
    auto own = numbered.reports.begin();
    const std::clock_t begin = std::clock();
    for (const virtual_wiimote::FrameTime& report : session.reports) {
      estimate = ours.update(report.arrival);
      (own++)->frame = estimate.frame;
    }
    seconds += static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    reports += session.reports.size();

    const double truth = session.reports.back().exposure + link.delay;
    arrival.push_back(session.reports.back().arrival - truth);
    squares.push_back(leastSquares(session) - truth);
    hull.push_back(convexHull(session) - truth);
    const auto toNearest = [&](double error) {
      return error - session.period * std::round(error / session.period);
    };
    own_squares.push_back(toNearest(leastSquares(numbered) - truth));
    own_hull.push_back(toNearest(convexHull(numbered) - truth));
    olsons.push_back(olson(session) - truth);
    best.push_back(oracle(session, link) - truth);
    if (blind_oracle && link.core == LinkModel::Core::kHardEdge) {
      const double error = oracleWithoutNumbers(session, link) - truth;
      blind.push_back(toNearest(error));
      blind_wrong += std::abs(error) > 0.5 * session.period;
    }
    // The reference of a bell is its mean less a typical spread.
    const double bell = link.core == LinkModel::Core::kBell ? 3.4 * link.jitter - 0.0024 : 0.0;
    const double error = estimate.exposure - truth - bell;
    const double frames = std::round(error / session.period);
    wrong += frames != 0.0;
    total.push_back(error);
    clock.push_back(error - frames * session.period);
    stddev.push_back(estimate.stddev);
    clock_stddev.push_back(estimate.clock_stddev);
  }
  const double bias = mean(clock);
  double ratio = 0.0;
  int covered = 0;
  for (std::size_t i = 0; i < clock.size(); ++i) {
    ratio += std::pow((clock[i] - bias) / clock_stddev[i], 2) / sessions;
    total[i] -= bias;
    covered += std::abs(total[i]) < 2.0 * stddev[i];
  }
  double total_square = 0.0;
  for (double t : total)
    total_square += t * t / sessions;

  TimingScore score;
  score.arrival = rmsAboutMean(arrival);
  score.least_squares = rmsAboutMean(squares);
  score.convex_hull = rmsAboutMean(hull);
  score.least_squares_own = rmsAboutMean(own_squares);
  score.convex_hull_own = rmsAboutMean(own_hull);
  score.olson = rmsAboutMean(olsons);
  score.oracle = rmsAboutMean(best);
  score.blind_oracle = blind.empty() ? 0.0 : rmsAboutMean(blind);
  score.blind_oracle_wrong_frames = static_cast<double>(blind_wrong) / sessions;
  score.clock = rmsAboutMean(clock);
  score.total = std::sqrt(total_square);
  score.wrong_frames = static_cast<double>(wrong) / sessions;
  score.clock_ratio = std::sqrt(ratio);
  score.covered = static_cast<double>(covered) / sessions;
  score.update_seconds = seconds / static_cast<double>(reports);
  return score;
}

}  // namespace wiimote_tracker::exposure_clock
