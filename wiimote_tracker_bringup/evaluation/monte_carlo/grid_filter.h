#ifndef WIIMOTE_TRACKER_BRINGUP_EVALUATION_MONTE_CARLO_GRID_FILTER_H
#define WIIMOTE_TRACKER_BRINGUP_EVALUATION_MONTE_CARLO_GRID_FILTER_H

#include <vector>

namespace wiimote_tracker::monte_carlo {

struct GridStamp {
  double exposure;  ///< [s]
  double stddev;    ///< [s]
};

/// What a causal estimator can reach on reports that were polled: Bayes' rule for the delay of the
/// newest report, on a grid of 0.1 ms, over all numbers of lost frames. Unlike the exposure clock,
/// it is told the spread of the delays, the polls, the losses, the wander (all as in recordings of
/// two remotes) and the period.
/// @param arrivals increasing [s]. @param period between frames [s].
/// @returns one stamp for each arrival; the mean delay is taken as 5 ms before the polls.
std::vector<GridStamp> gridStamps(const std::vector<double>& arrivals, double period);

}  // namespace wiimote_tracker::monte_carlo

#endif  // WIIMOTE_TRACKER_BRINGUP_EVALUATION_MONTE_CARLO_GRID_FILTER_H
