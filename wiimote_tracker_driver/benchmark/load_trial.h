#ifndef WIIMOTE_TRACKER_DRIVER_BENCHMARK_LOAD_TRIAL_H
#define WIIMOTE_TRACKER_DRIVER_BENCHMARK_LOAD_TRIAL_H

#include "results.h"

namespace wiimote_tracker {

/// Virtual remotes in their own process, at 100 Hz each, and driver nodelets in this process, which
/// subscribes to their blobs as another nodelet would. Measures for `duration` [s]: CPU time of
/// this process, time from the remote's sample to the subscriber's callback, and lost data reports.
/// Starts its own ROS master. Call it while this process has one thread. @throws std::runtime_error
/// when it cannot be measured; what() says what to do.
Results runLoad(int remotes, double duration);

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_DRIVER_BENCHMARK_LOAD_TRIAL_H
