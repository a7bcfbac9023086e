#ifndef WIIMOTE_TRACKER_DRIVER_BENCHMARK_LOAD_TRIAL_H
#define WIIMOTE_TRACKER_DRIVER_BENCHMARK_LOAD_TRIAL_H

#include "results.h"

namespace wiimote_tracker {

/// So many virtual remotes, in a process of their own, at 100 Hz each, into driver nodelets in this
/// process, which subscribes to their blobs as a nodelet beside them would. Measures for `duration`
/// [s]: processor time of this process, time from the remote's sample to the subscriber's callback,
/// and data reports that never got there. Brings its own ROS master. To be called while this
/// process has one thread. @throws std::runtime_error when it cannot be measured; what() says what
/// to do.
Results runLoad(int remotes, double duration);

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_DRIVER_BENCHMARK_LOAD_TRIAL_H
