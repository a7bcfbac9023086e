#ifndef WIIMOTE_TRACKER_DRIVER_BENCHMARK_SOAK_TRIAL_H
#define WIIMOTE_TRACKER_DRIVER_BENCHMARK_SOAK_TRIAL_H

#include "results.h"

#include <cstdint>

namespace wiimote_tracker {

/// A month or less of one remote in fake time, as fast as possible: data reports through decoder,
/// state machine and stamper. Every hour the connection is lost, the remote loses its mode, or its
/// power is cycled; batteries last for 40 hours. The clocks are those of SoakStamps.
/// @param reports more than the 25 hours after which memory must not grow: 1e7; 2.6e8 are 30 days.
/// @param hour [s]; a short one for tests.
Results runSoak(std::uint64_t reports, double hour = 3600.0);

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_DRIVER_BENCHMARK_SOAK_TRIAL_H
