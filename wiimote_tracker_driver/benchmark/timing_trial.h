#pragma once

#include "simulated_link.h"

namespace wiimote_tracker::exposure_clock {

/// Errors of the last report's exposure time [s].
struct TimingErrors {
  double arrival = 0.0;
  /// With the true frame numbers.
  double oracle = 0.0, least_squares = 0.0, convex_hull = 0.0;
  /// With the numbers of a receiver: ours, as they were when each report came. To the nearest true
  /// exposure.
  double convex_hull_own = 0.0;
  double clock = 0.0;  ///< ours, to the nearest true exposure
};

/// Root mean square errors of the last report's exposure time over many sessions [s], each less its
/// mean over the sessions (the constant part of the delay).
struct TimingScore : TimingErrors {
  double total;           ///< ours, with wrongly numbered frames
  double wrong_frames;    ///< share of last reports assigned to another frame
  double clock_ratio;     ///< RMS of error / clock_stddev
  double covered;         ///< share of total errors within 2 stddev
  double update_seconds;  ///< CPU time per report
};

/// Plays `sessions` sessions of `duration` [s] with seeds `first_seed`, `first_seed` + 1, ...
TimingScore runTiming(const LinkModel& link,
                      double duration,
                      int sessions,
                      std::uint64_t first_seed = 1);

}  // namespace wiimote_tracker::exposure_clock
