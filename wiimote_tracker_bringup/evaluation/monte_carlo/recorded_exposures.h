#ifndef WIIMOTE_TRACKER_BRINGUP_EVALUATION_MONTE_CARLO_RECORDED_EXPOSURES_H
#define WIIMOTE_TRACKER_BRINGUP_EVALUATION_MONTE_CARLO_RECORDED_EXPOSURES_H

#include <vector>

namespace wiimote_tracker::monte_carlo {

/// When the images of a recording were exposed, by all of its arrivals, earlier and later ones: the
/// most probable frame numbers (Viterbi 1967), and a random walk of the camera's phase, smoothed
/// (Rauch, Tung and Striebel 1965), in turn, from the exposure clock's numbers on.
/// @param arrivals of a remote's reports, increasing [s]; two or more.
/// @returns one exposure for each [s]. The mean delay is not known and is taken as 5 ms.
std::vector<double> recordedExposures(const std::vector<double>& arrivals);

}  // namespace wiimote_tracker::monte_carlo

#endif  // WIIMOTE_TRACKER_BRINGUP_EVALUATION_MONTE_CARLO_RECORDED_EXPOSURES_H
