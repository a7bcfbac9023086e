#pragma once

// Counts the heap allocations of a test program and its libraries, also those of Eigen's matrices,
// which do not use operator new. Include it in one source file only: it replaces malloc() and
// operator new.

#include <dlfcn.h>

#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <new>

namespace {
std::atomic<int> g_allocations{0};
}  // namespace

extern "C" void* malloc(std::size_t size) noexcept {
  static const auto next = reinterpret_cast<void* (*)(std::size_t)>(::dlsym(RTLD_NEXT, "malloc"));
  ++g_allocations;
  return next(size);
}

extern "C" void* realloc(void* memory, std::size_t size) noexcept {
  static const auto next =
      reinterpret_cast<void* (*)(void*, std::size_t)>(::dlsym(RTLD_NEXT, "realloc"));
  ++g_allocations;
  return next(memory, size);
}

// A sanitizer's would not call malloc(). Never inlined: the compiler would see free() on memory
// that came from new.
[[gnu::noinline]] void* operator new(std::size_t size) {
  if (void* memory = std::malloc(size))
    return memory;
  throw std::bad_alloc();
}
// std::stable_sort takes its memory from this one.
[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  return std::malloc(size);
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
