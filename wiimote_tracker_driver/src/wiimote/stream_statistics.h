#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>

namespace wiimote_tracker::wiimote {

/// Rate and gaps of the images since the last take().
class StreamStatistics {
 public:
  /// Longer than this between two images [s] counts as a gap: five images at a remote's 100 Hz.
  static constexpr double kGap = 0.05;

  /// The rate of a stream that began less than this before take() says little [s].
  static constexpr double kShortest = 0.5;

  /// For so long it is known that the stream began again [s].
  static constexpr double kMemory = 600.0;

  struct Summary {
    double rate = 0.0;         ///< [Hz] Since the stream began, if that was in this window.
    bool has_rate = true;      ///< False: it began less than kShortest ago, and `rate` is too low.
    double longest_gap = 0.0;  ///< [s] Including the time since the last image.
    std::uint64_t gaps = 0;    ///< Since the beginning.
    int returns = 0;           ///< Streams that began again after lose() within kMemory.
  };

  /// `now` [s] here and below is any clock that never goes back.
  explicit StreamStatistics(double now) : window_start_(now), last_image_(now) {}

  /// The stream begins, at first or again.
  void begin(double now) {
    if (any_image_ && was_lost_)
      returns_.push_back(now);
    was_lost_ = false;
    window_start_ = now;
    images_ = 0;
    has_begun_ = true;
  }

  /// The remote is gone.
  void lose() { was_lost_ = true; }

  /// An image has come.
  void add(double now) {
    const double interval = now - last_image_;
    // The time before the first image is no gap.
    if (any_image_ && interval > kGap)
      ++gaps_;
    any_image_ = true;
    longest_ = std::max(longest_, interval);
    last_image_ = now;
    ++images_;
  }

  /// Returns the summary of this window and begins the next one.
  Summary take(double now) {
    Summary summary;
    const double duration = now - window_start_;
    summary.has_rate = !has_begun_ || duration >= kShortest;
    if (duration > 0.0)
      summary.rate = static_cast<double>(images_) / (summary.has_rate ? duration : kShortest);
    summary.longest_gap = std::max(longest_, now - last_image_);
    summary.gaps = gaps_;
    while (!returns_.empty() && returns_.front() < now - kMemory)
      returns_.pop_front();
    summary.returns = static_cast<int>(returns_.size());
    window_start_ = now;
    images_ = 0;
    has_begun_ = false;
    longest_ = 0.0;
    return summary;
  }

 private:
  double window_start_;
  double last_image_;
  double longest_ = 0.0;
  bool any_image_ = false;
  bool has_begun_ = false;  // in this window
  std::uint64_t images_ = 0;
  std::uint64_t gaps_ = 0;
  bool was_lost_ = false;
  std::deque<double> returns_;  // when the stream began again [s]
};

}  // namespace wiimote_tracker::wiimote
