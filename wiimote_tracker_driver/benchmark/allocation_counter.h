#pragma once

#include <cstdint>

namespace wiimote_tracker {

/// Counts operator new and delete in this program, which allocation_counter.cpp replaces.
struct Allocations {
  std::uint64_t made = 0;
  std::uint64_t alive = 0;  ///< Not freed.
};

Allocations allocations();

}  // namespace wiimote_tracker
