#pragma once

#include <vector>

namespace wiimote_tracker::monte_carlo {

struct GridStamp {
  double exposure;  ///< [s]
  double stddev;    ///< [s]
};

struct GridStamps {
  std::vector<GridStamp> filtered;  ///< By the arrivals so far.
  std::vector<GridStamp> smoothed;  ///< By all arrivals.
};

/// Exposure times by an estimator that knows more than the exposure clock, for reports that were
/// polled: Bayes' rule for the delay of a report, on a grid of 0.1 ms, over all numbers of lost
/// frames. It is told the spread of the delays, the polls, the losses and the wander, all as in
/// recordings of two remotes, and finds the period.
/// @param arrivals of a remote's reports, increasing [s]; two or more.
/// @returns one stamp for each arrival; the mean delay is taken as 5 ms before the polls.
GridStamps gridStamps(const std::vector<double>& arrivals);

}  // namespace wiimote_tracker::monte_carlo
