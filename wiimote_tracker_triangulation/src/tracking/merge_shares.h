#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace wiimote_tracker::tracking {

/// Which part of a track's recent spots is merged with another track's: two tracks that share
/// nearly all of 64 spots follow one LED; two LEDs that pass each other share fewer.
class MergeShares {
 public:
  void addAlone() {
    ++alone_;
    unmerged_ += (1.0 - unmerged_) / kShortMemory;
  }

  /// @param is_own false: the merged spot is assigned to the other track.
  void addMerged(std::uint32_t other, bool is_own) {
    const double memory =
        std::min(std::max(0.5 * static_cast<double>(alone_), kShortMemory), kLongMemory);
    unmerged_ -= unmerged_ / memory;
    own_ += ((is_own ? 1.0 : 0.0) - own_) / kShortMemory;
    other_ = other;
  }

  /// All spots of this LED alone.
  std::size_t alone() const { return alone_; }

  /// Whether the other track that shares nearly all spots is the better one: most spots were
  /// assigned to it, or about half and it is the older one. @param id of this track
  bool isDuplicate(std::uint32_t id) const {
    constexpr double kLeastUnmerged = 0.15;
    constexpr double kMostlyOwn = 0.7;
    return unmerged_ < kLeastUnmerged &&
           (own_ < 1.0 - kMostlyOwn || (own_ < kMostlyOwn && other_ < id));
  }

 private:
  // Time constants [spots]. A track with many spots of its own uses the longer one.
  static constexpr double kShortMemory = 64.0;
  static constexpr double kLongMemory = 256.0;

  std::size_t alone_ = 0;
  double unmerged_ = 1.0;    // share of recent spots that are this LED's alone
  double own_ = 0.5;         // share of recent merged spots assigned to this LED
  std::uint32_t other_ = 0;  // with which the last merged spot was shared
};

}  // namespace wiimote_tracker::tracking
