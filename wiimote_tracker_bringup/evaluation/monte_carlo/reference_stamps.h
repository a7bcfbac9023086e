#ifndef WIIMOTE_TRACKER_BRINGUP_EVALUATION_MONTE_CARLO_REFERENCE_STAMPS_H
#define WIIMOTE_TRACKER_BRINGUP_EVALUATION_MONTE_CARLO_REFERENCE_STAMPS_H

#include <vector>

// Exposure times by estimators that know more than the exposure clock.
namespace wiimote_tracker::monte_carlo {

/// When the images of a recording were exposed, by all of its arrivals, earlier and later ones: the
/// most probable frame numbers (Viterbi 1967), and a random walk of the camera's phase, smoothed
/// (Rauch, Tung and Striebel 1965), in turn, from the exposure clock's numbers on.
/// @param arrivals of a remote's reports, increasing [s]; two or more.
/// @returns one exposure for each [s]. The mean delay is not known and is taken as 5 ms.
std::vector<double> recordedExposures(const std::vector<double>& arrivals);

struct GridStamp {
  double exposure;  ///< [s]
  double stddev;    ///< [s]
};

/// A causal estimator for reports that were polled: Bayes' rule for the delay of the
/// newest report, on a grid of 0.1 ms, over all numbers of lost frames. Unlike the exposure clock,
/// it is told the spread of the delays, the polls, the losses, the wander (all as in recordings of
/// two remotes) and the period.
/// @param arrivals increasing [s]. @param period between frames [s].
/// @returns one stamp for each arrival; the mean delay is taken as 5 ms before the polls.
std::vector<GridStamp> gridStamps(const std::vector<double>& arrivals, double period);

}  // namespace wiimote_tracker::monte_carlo

#endif  // WIIMOTE_TRACKER_BRINGUP_EVALUATION_MONTE_CARLO_REFERENCE_STAMPS_H
