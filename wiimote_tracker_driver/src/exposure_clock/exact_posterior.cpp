#include "exposure_clock/exact_posterior.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace wiimote_tracker::exposure_clock {

namespace {
constexpr int kMinBlocks = 8;
// Number of first reports that are skipped, because their frame numbers are overconfident.
constexpr int kSkippedReports = 25;

/// Of the density exp(slope * x) on an interval: logarithm of its integral relative to its greatest
/// value, mean and variance of x.
struct Piece {
  double log_integral, mean, variance;
};
Piece exponentialPiece(double begin, double end, double slope) {
  const double length = end - begin;
  const double rise = slope * length;
  // The mean and mean square of u = (x - begin) / length.
  double log_integral, u, uu;
  if (std::abs(rise) < 1e-3) {  // series
    log_integral = -0.5 * std::abs(rise);
    u = 0.5 + rise / 12.0;
    uu = 1.0 / 3.0 + rise / 12.0;
  } else {
    log_integral = std::log(-std::expm1(-std::abs(rise)) / std::abs(rise));
    const double at_end = -1.0 / std::expm1(-rise);
    u = at_end - 1.0 / rise;
    uu = at_end - 2.0 * u / rise;
  }
  return {std::log(length) + log_integral, begin + length * u,
          length * length * std::max(0.0, uu - u * u)};
}
}  // namespace

ExactPosterior::ExactPosterior(double period, double tolerance)
    : nominal_period_(period), tolerance_(tolerance) {}

void ExactPosterior::clear() {
  *this = ExactPosterior(nominal_period_, tolerance_);
}

bool ExactPosterior::ready() const {
  return reports_ > kSkippedReports + kMinBlocks * kBlockReports;
}

void ExactPosterior::add(std::int64_t frame, double arrival, double weight, double period) {
  const std::int64_t report = reports_++ - kSkippedReports;
  if (report < 0)
    return;
  if (report == 0) {
    first_frame_ = frame;
    first_arrival_ = arrival;
  }
  const bool begins = report % kBlockReports == 0;
  Block& block = blocks_[static_cast<std::size_t>(report / kBlockReports % kBlocks)];
  if (begins)
    block = Block();
  const auto n = static_cast<double>(frame - first_frame_);
  block.weight += weight;
  block.weighted_frames += weight * n;
  const Point point{n, arrival - first_arrival_ - n * nominal_period_};
  const double drift = period - nominal_period_;
  if (begins ||
      point.time - point.frame * drift < block.earliest.time - block.earliest.frame * drift)
    block.earliest = point;
}

// Andrew's monotone chain; the blocks are in order of their frames.
ExactPosterior::Hull ExactPosterior::lowerHull() const {
  Hull hull;
  const std::int64_t begun = (reports_ - kSkippedReports + kBlockReports - 1) / kBlockReports;
  for (std::int64_t i = std::max<std::int64_t>(0, begun - kBlocks); i < begun; ++i) {
    const Point& p = blocks_[static_cast<std::size_t>(i % kBlocks)].earliest;
    if (!hull.empty() && p.frame <= hull.back().frame)
      continue;
    const auto bulges = [&] {
      const Point &a = hull[hull.size() - 2], &b = hull.back();
      return (b.time - a.time) * (p.frame - a.frame) >= (p.time - a.time) * (b.frame - a.frame);
    };
    while (hull.size() > 1 && bulges())
      hull.pop_back();
    hull.push_back(p);
  }
  return hull;
}

ClockState ExactPosterior::state(std::int64_t frame, double spread) const {
  double weight = 0.0, mean_frame = 0.0;
  for (const Block& block : blocks_) {
    weight += block.weight;
    mean_frame += block.weighted_frames;
  }
  mean_frame /= weight;
  const double rate = weight / spread;

  const Hull hull = lowerHull();
  // Relative to the latest corner, for precision after days.
  const Point origin = hull.back();
  mean_frame -= origin.frame;
  const auto n = static_cast<double>(frame - first_frame_);
  // Drift is the period less the nominal one. Each corner bounds the phase where the slopes of the
  // hull beside it say; sums are of (time, drift) over these pieces, weighed by their probability.
  double scale = -std::numeric_limits<double>::infinity();  // logarithm of the greatest weight
  double sum = 0.0, time = 0.0, drift = 0.0, tt = 0.0, td = 0.0, dd = 0.0;
  double begin = -tolerance_;
  for (std::size_t i = 0; i < hull.size() && begin < tolerance_; ++i) {
    const auto relative = [&](std::size_t k) {
      return Point{hull[k].frame - origin.frame, hull[k].time - origin.time};
    };
    const Point corner = relative(i);
    double end = tolerance_;
    if (i + 1 < hull.size()) {
      const Point next = relative(i + 1);
      end = std::min(end, (next.time - corner.time) / (next.frame - corner.frame));
    }
    if (end <= begin)
      continue;
    const double slope = rate * (mean_frame - corner.frame);
    const Piece piece = exponentialPiece(begin, end, slope);
    const double log_mass =
        piece.log_integral + rate * corner.time + slope * (slope > 0.0 ? end : begin);
    if (log_mass > scale) {
      const double smaller = std::exp(scale - log_mass);
      for (double* s : {&sum, &time, &drift, &tt, &td, &dd})
        *s *= smaller;
      scale = log_mass;
    }
    const double mass = std::exp(log_mass - scale);
    const double frames = n - origin.frame - corner.frame;
    const double t = corner.time + frames * piece.mean, d = piece.mean;
    sum += mass;
    time += mass * t;
    drift += mass * d;
    tt += mass * (t * t + frames * frames * piece.variance);
    td += mass * (t * d + frames * piece.variance);
    dd += mass * (d * d + piece.variance);
    begin = end;
  }
  time /= sum;
  drift /= sum;
  const double below = 1.0 / rate;  // mean and standard deviation of the phase below its bound
  ClockState result;
  result.time = first_arrival_ + n * nominal_period_ + origin.time + time - below;
  result.period = nominal_period_ + drift;
  result.p00 = std::max(0.0, tt / sum - time * time) + below * below;
  result.p01 = td / sum - time * drift;
  result.p11 = std::max(0.0, dd / sum - drift * drift);
  return result;
}

}  // namespace wiimote_tracker::exposure_clock
