#ifndef WIIMOTE_TRACKER_DRIVER_BENCHMARK_ALLOCATION_COUNTER_H
#define WIIMOTE_TRACKER_DRIVER_BENCHMARK_ALLOCATION_COUNTER_H

#include <cstdint>

namespace wiimote_tracker {

/// Calls of operator new in this program, which allocation_counter.cpp replaces, and of its
/// counterpart.
struct Allocations {
  std::uint64_t made = 0;
  std::uint64_t alive = 0;  ///< Not given back.
};

Allocations allocations();

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_DRIVER_BENCHMARK_ALLOCATION_COUNTER_H
