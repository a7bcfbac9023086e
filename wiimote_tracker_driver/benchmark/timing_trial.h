#ifndef WIIMOTE_TRACKER_DRIVER_TIMING_TRIAL_H
#define WIIMOTE_TRACKER_DRIVER_TIMING_TRIAL_H

#include "simulated_link.h"

namespace wiimote_tracker::exposure_clock {

/// Errors of the last report's exposure time over many sessions, each less its mean over the
/// sessions (the constant part of the delay). Root mean squares [s].
struct TimingScore {
  double arrival, oracle;
  /// Not told the frame numbers; hard edge only, else 0. To the nearest true exposure, and share of
  /// last reports taken for another frame.
  double blind_oracle, blind_oracle_wrong_frames;
  /// Told the true frame numbers,
  double least_squares, convex_hull, olson;
  /// and with the numbers that a receiver has: ours, as they were when each report came. To the
  /// nearest true exposure.
  double least_squares_own, convex_hull_own;
  double clock;           ///< ours, to the nearest true exposure
  double total;           ///< ours, with wrongly numbered frames
  double wrong_frames;    ///< share of last reports taken for another frame
  double clock_ratio;     ///< RMS of error / clock_stddev
  double covered;         ///< share of total errors within 2 stddev
  double update_seconds;  ///< processor time per report
};

/// Plays `sessions` sessions of `duration` [s] with seeds `first_seed`, `first_seed` + 1, ... The
/// oracle without numbers takes much longer than all else.
TimingScore runTiming(const LinkModel& link,
                      double duration,
                      int sessions,
                      bool blind_oracle,
                      std::uint64_t first_seed = 1);

}  // namespace wiimote_tracker::exposure_clock

#endif
