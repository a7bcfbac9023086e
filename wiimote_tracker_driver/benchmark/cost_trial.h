#ifndef WIIMOTE_TRACKER_DRIVER_BENCHMARK_COST_TRIAL_H
#define WIIMOTE_TRACKER_DRIVER_BENCHMARK_COST_TRIAL_H

#include "results.h"

namespace wiimote_tracker {

/// Processor time of driver_node with one virtual remote at 100 Hz, beside a node that does nothing
/// but publish the same message as often. Both run at the same time, without and with a subscriber
/// in turn, `duration` [s] each in all. Call it while this process has one thread.
/// @throws std::runtime_error.
Results runCost(double duration);

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_DRIVER_BENCHMARK_COST_TRIAL_H
