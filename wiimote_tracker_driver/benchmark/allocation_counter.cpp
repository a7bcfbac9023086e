#include "allocation_counter.h"

#include <atomic>
#include <cstdlib>
#include <new>

namespace {

std::atomic<std::uint64_t> made{0};
std::atomic<std::uint64_t> released{0};

}  // namespace

// The other forms of new and delete call these, except those of over-aligned types, which the
// driver does not have.
void* operator new(std::size_t size) {
  made.fetch_add(1, std::memory_order_relaxed);
  if (void* memory = std::malloc(size > 0 ? size : 1))
    return memory;
  throw std::bad_alloc();
}

// A sanitizer's would not call the one above, and std::stable_sort releases what it got from this
// one with the delete below.
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  made.fetch_add(1, std::memory_order_relaxed);
  return std::malloc(size > 0 ? size : 1);
}

void operator delete(void* memory) noexcept {
  if (memory)
    released.fetch_add(1, std::memory_order_relaxed);
  std::free(memory);
}

void operator delete(void* memory, std::size_t) noexcept {
  operator delete(memory);
}

namespace wiimote_tracker {

Allocations allocations() {
  Allocations result;
  result.made = made.load();
  result.alive = result.made - released.load();
  return result;
}

}  // namespace wiimote_tracker
