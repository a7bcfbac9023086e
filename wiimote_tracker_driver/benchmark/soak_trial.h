#ifndef WIIMOTE_TRACKER_DRIVER_BENCHMARK_SOAK_TRIAL_H
#define WIIMOTE_TRACKER_DRIVER_BENCHMARK_SOAK_TRIAL_H

#include "results.h"

#include <cstdint>

namespace wiimote_tracker {

/// Sends data reports (>= 1e7; 6e7 are a week's) through decoder and state machine in fake time, as
/// fast as possible. Every hour the remote loses its mode, every six hours its power is cycled, and
/// once a day the connection is lost.
Results runSoak(std::uint64_t reports);

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_DRIVER_BENCHMARK_SOAK_TRIAL_H
