#pragma once

#include <boost/container/static_vector.hpp>

#include <array>
#include <cstdint>

namespace wiimote_tracker::exposure_clock {

/// Time of a frame and period of the clock, with their covariance.
struct ClockState {
  double time = 0.0, period = 0.0;         ///< [s]
  double p00 = 0.0, p01 = 0.0, p11 = 0.0;  ///< [s^2]
};

/// Phase and period of a steady clock behind exponential delays: the exact posterior instead of a
/// normal one.
///
/// No frame arrives before its time: phase + k period <= arrival for every report, which bounds a
/// polygon open to below. Inside it the density is proportional to exp(sum of weights * (phase +
/// mean(k) * period) / spread). Given the period, the phase is thus an exponential below its bound;
/// the density of the period is piecewise exponential, one piece per corner of the lower convex
/// hull of the arrivals. Mean and covariance are sums over these pieces.
///
/// Of the last 20 s each block keeps its earliest report, relative to the line of the period. These
/// include all corners except where a block has two.
class ExactPosterior {
 public:
  /// Prior of the period: uniform within `period` +- `tolerance` [s].
  ExactPosterior(double period, double tolerance);

  void clear();
  /// Adds a report with a certain frame number, on time with probability `weight`. `period` [s] is
  /// the best estimate so far. Frames increase.
  void add(std::int64_t frame, double arrival, double weight, double period);
  /// Whether there are enough reports for state().
  bool ready() const;

  /// Of `frame`, once ready(). @param spread mean of the exponential [s].
  ClockState state(std::int64_t frame, double spread) const;

 private:
  static constexpr int kBlocks = 64;
  static constexpr int kBlockReports = 32;
  struct Point {
    double frame;  // after the first frame of all
    double time;   // arrival, less the nominal time of the frame
  };
  struct Block {
    double weight = 0.0, weighted_frames = 0.0;
    Point earliest{};
  };
  using Hull = boost::container::static_vector<Point, kBlocks>;
  Hull lowerHull() const;

  double nominal_period_, tolerance_;
  std::array<Block, kBlocks> blocks_;
  std::int64_t reports_ = 0;  // since clear(), with those that were skipped
  std::int64_t first_frame_ = 0;
  double first_arrival_ = 0.0;
};

}  // namespace wiimote_tracker::exposure_clock
