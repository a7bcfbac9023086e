#include "body/inertial_samples.h"

#include <algorithm>
#include <limits>

namespace wiimote_tracker::body {
namespace {

constexpr double kKept = 2.0;           // [s]
constexpr double kLongestPause = 0.05;  // [s]

}  // namespace

std::vector<InertialSample>::const_iterator InertialSamples::after(double time) const {
  return std::upper_bound(samples_.begin(), samples_.end(), time,
                          [](double t, const InertialSample& sample) { return t < sample.time; });
}

double InertialSamples::add(const InertialSample& sample) {
  double newest = std::numeric_limits<double>::infinity();
  if (!samples_.empty() && sample.time < samples_.back().time - kKept)
    samples_.clear();
  if (!samples_.empty()) {
    newest = samples_.back().time;
    if (!(sample.time > newest))
      return std::numeric_limits<double>::infinity();
  }
  samples_.erase(samples_.begin(), after(sample.time - kKept));
  samples_.push_back(sample);
  return newest;
}

bool InertialSamples::cover(double begin, double end) const {
  auto next = after(begin);
  if (next == samples_.begin())
    return false;
  for (; next != samples_.end() && std::prev(next)->time < end; ++next) {
    if (next->time - std::prev(next)->time > kLongestPause)
      return false;
  }
  return end - std::prev(next)->time <= kLongestPause;
}

InertialSample InertialSamples::at(double time) const {
  const auto next = after(time);
  const InertialSample& last = *std::prev(next);
  if (next == samples_.end())
    return {time, last.rate, last.force};
  const double share = (time - last.time) / (next->time - last.time);
  return {time, last.rate + share * (next->rate - last.rate),
          last.force + share * (next->force - last.force)};
}

double InertialSamples::nextAfter(double time) const {
  const auto next = after(time);
  return next == samples_.end() ? std::numeric_limits<double>::infinity() : next->time;
}

double InertialSamples::frequency() const {
  return samples_.size() < 2 ? 0.0
                             : static_cast<double>(samples_.size() - 1) /
                                   (samples_.back().time - samples_.front().time);
}

}  // namespace wiimote_tracker::body
