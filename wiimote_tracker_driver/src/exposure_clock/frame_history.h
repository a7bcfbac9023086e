#pragma once

#include "exposure_clock/frame_counter.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace wiimote_tracker::exposure_clock {

/// Smoothed frame numbers of the latest reports, because later reports often decide which frame a
/// report was. From FrameCounter's probabilities alone (Kitagawa, J. Am. Stat. Assoc. 82, 1987);
/// Rabiner's backward recursion would need the likelihoods again.
class FrameHistory {
 public:
  struct Report {
    double arrival = 0.0;
    bool waited = false;       ///< it arrived at an unknown time before that
    std::int64_t frame = 0;    ///< most probable smoothed number,
    double probability = 0.0;  ///< and its probability
    double lost = 0.0;         ///< probability that frames before it were lost,
    double kept = 0.0;         ///< and that none was
  };

  void clear() { size_ = 0; }
  /// The latest report and its possible numbers.
  void add(const FrameCounter& numbers, double arrival, bool waited = false);
  /// Whether more reports would not help: the latest number is certain, or memory is full.
  bool complete() const;
  /// Smooths the numbers of all reports so far, of which add() then keeps only the latest.
  /// report(0), the oldest, is that of the last time. @param counter has the loss probability.
  /// @return their count.
  int smooth(const FrameCounter& counter);
  const Report& report(int i) const { return entries_[static_cast<std::size_t>(i)].report; }

 private:
  static constexpr int kCapacity = 32;
  static constexpr std::size_t kNumbers = 8;  // kept of each report
  struct Entry {
    Report report;
    std::int64_t first = 0;
    std::array<double, kNumbers> probability{};
  };
  static void smoothEntry(const FrameCounter& counter, Entry* entry, Entry* next);
  static void decide(Entry* entry);

  std::array<Entry, kCapacity> entries_;
  int size_ = 0;
};

}  // namespace wiimote_tracker::exposure_clock
