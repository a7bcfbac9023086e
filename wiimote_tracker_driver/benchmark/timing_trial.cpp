#include "timing_trial.h"

#include "reference_clocks.h"
#include "wiimote_tracker_driver/exposure_clock/exposure_clock.h"

#include <cmath>
#include <ctime>
#include <vector>

namespace wiimote_tracker::exposure_clock {

namespace {

/// One session.
struct Trial : TimingErrors {
  double total = 0.0;
  bool wrong_frame = false;
  double clock_stddev = 0.0, stddev = 0.0;
  double seconds = 0.0;     ///< CPU time of the clock.
  std::size_t reports = 0;  ///< That it took.
};

double mean(const std::vector<Trial>& trials, double TimingErrors::*error) {
  double sum = 0.0;
  for (const Trial& trial : trials)
    sum += trial.*error;
  return sum / static_cast<double>(trials.size());
}
double rmsAboutMean(const std::vector<Trial>& trials, double TimingErrors::*error) {
  const double m = mean(trials, error);
  double sum = 0.0;
  for (const Trial& trial : trials)
    sum += (trial.*error - m) * (trial.*error - m);
  return std::sqrt(sum / (static_cast<double>(trials.size()) - 1.0));
}

Trial run(const LinkModel& link, double duration, std::uint64_t seed) {
  const SimulatedSession session = simulate(link, duration, seed);
  Trial trial;
  ExposureClock ours;
  Estimate estimate;
  SimulatedSession numbered = session;
  auto own = numbered.reports.begin();
  const std::clock_t begin = std::clock();
  for (const virtual_wiimote::FrameTime& report : session.reports) {
    estimate = ours.update(report.arrival);
    (own++)->frame = estimate.frame;
  }
  trial.seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  trial.reports = session.reports.size();

  const double truth = session.reports.back().exposure + link.delay;
  const auto toNearest = [&](double error) {
    return error - session.period * std::round(error / session.period);
  };
  trial.arrival = session.reports.back().arrival - truth;
  trial.least_squares = leastSquares(session) - truth;
  trial.convex_hull = convexHull(session) - truth;
  trial.convex_hull_own = toNearest(convexHull(numbered) - truth);
  trial.oracle = oracle(session, link) - truth;
  // The reference of normal delays is their mean less a typical spread.
  const double reference = link.core == LinkModel::Core::kNormal ? 3.4 * link.jitter - 0.0024 : 0.0;
  trial.total = estimate.exposure - truth - reference;
  trial.clock = toNearest(trial.total);
  trial.wrong_frame = std::round(trial.total / session.period) != 0.0;
  trial.stddev = estimate.stddev;
  trial.clock_stddev = estimate.clock_stddev;
  return trial;
}

}  // namespace

TimingScore runTiming(const LinkModel& link,
                      double duration,
                      int sessions,
                      std::uint64_t first_seed) {
  std::vector<Trial> trials;
  for (int i = 0; i < sessions; ++i)
    trials.push_back(run(link, duration, first_seed + static_cast<std::uint64_t>(i)));
  TimingScore score{};
  const double bias = mean(trials, &Trial::clock);
  double ratio = 0.0, total_square = 0.0;
  std::size_t reports = 0;
  for (const Trial& trial : trials) {
    const double total = trial.total - bias;
    ratio += std::pow((trial.clock - bias) / trial.clock_stddev, 2) / sessions;
    total_square += total * total / sessions;
    score.covered += (std::abs(total) < 2.0 * trial.stddev) / static_cast<double>(sessions);
    score.wrong_frames += trial.wrong_frame / static_cast<double>(sessions);
    score.update_seconds += trial.seconds;
    reports += trial.reports;
  }
  score.clock_ratio = std::sqrt(ratio);
  score.total = std::sqrt(total_square);
  score.update_seconds /= static_cast<double>(reports);
  using E = TimingErrors;
  for (const auto error : {&E::arrival, &E::oracle, &E::least_squares, &E::convex_hull,
                           &E::convex_hull_own, &E::clock})
    score.*error = rmsAboutMean(trials, error);
  return score;
}

}  // namespace wiimote_tracker::exposure_clock
