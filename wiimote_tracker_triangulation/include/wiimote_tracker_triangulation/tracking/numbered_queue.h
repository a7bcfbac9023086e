#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace wiimote_tracker::tracking {

/// A queue whose elements are numbered from the first one ever added. Reuses its elements, so that
/// it does not allocate once it has grown to its working size.
template <typename T>
class NumberedQueue {
 public:
  std::uint64_t begin() const { return begin_; }
  std::uint64_t end() const { return begin_ + size_; }
  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }

  T& at(std::uint64_t number) { return ring_[number % ring_.size()]; }
  const T& at(std::uint64_t number) const { return ring_[number % ring_.size()]; }
  const T& front() const { return at(begin()); }
  const T& back() const { return at(end() - 1); }

  /// Adds an element at the end; its value is that of a former element.
  T& push() {
    if (size_ == ring_.size())
      grow();
    ++size_;
    return at(end() - 1);
  }

  void popFront() {
    ++begin_;
    --size_;
  }
  void popBack() { --size_; }

  void clear() {
    begin_ = 0;
    size_ = 0;
  }

 private:
  void grow() {
    std::vector<T> larger(2 * ring_.size() + 8);
    for (std::uint64_t number = begin(); number < end(); ++number)
      std::swap(larger[number % larger.size()], at(number));
    ring_.swap(larger);
  }

  std::vector<T> ring_;
  std::uint64_t begin_ = 0;
  std::size_t size_ = 0;
};

}  // namespace wiimote_tracker::tracking
