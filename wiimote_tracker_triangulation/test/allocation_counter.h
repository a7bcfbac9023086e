#ifndef WIIMOTE_TRACKER_TRIANGULATION_TEST_ALLOCATION_COUNTER_H
#define WIIMOTE_TRACKER_TRIANGULATION_TEST_ALLOCATION_COUNTER_H

// Counts the heap allocations of a test program. Include it in one source file only: it replaces
// operator new.

#include <cstddef>
#include <cstdlib>
#include <new>

namespace {
int g_allocations = 0;
}  // namespace

// Never inlined: the compiler would see free() on memory that came from new.
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++g_allocations;
  if (void* memory = std::malloc(size))
    return memory;
  throw std::bad_alloc();
}
// std::stable_sort takes its memory from this one.
[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  ++g_allocations;
  return std::malloc(size);
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

#endif  // WIIMOTE_TRACKER_TRIANGULATION_TEST_ALLOCATION_COUNTER_H
