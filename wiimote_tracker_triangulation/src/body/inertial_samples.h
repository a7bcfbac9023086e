#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <iterator>
#include <limits>
#include <vector>

namespace wiimote_tracker::body {

/// What an IMU on a body measured, along the body's axes.
struct InertialSample {
  double time;            ///< By the clock of the images [s].
  Eigen::Vector3d rate;   ///< Angular velocity [rad/s].
  Eigen::Vector3d force;  ///< Specific force: acceleration less that of gravity [m/s^2].
};

/// The samples of an IMU in the last seconds. Does not allocate once warm.
class InertialSamples {
 public:
  /// @param place of the IMU in the body's frame [m].
  explicit InertialSamples(const Eigen::Vector3d& place) : place_(place) {}

  const Eigen::Vector3d& place() const { return place_; }

  /// A sample that is not newer than all others is ignored, unless time jumped back, as when a bag
  /// starts again: then the others are forgotten.
  /// @returns the time after which this changes what at() says [s].
  double add(const InertialSample& sample) {
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

  void clear() { samples_.clear(); }

  /// Whether no two successive samples are too far apart (0.05 s) from `begin` to `end` [s].
  bool cover(double begin, double end) const {
    auto next = after(begin);
    if (next == samples_.begin())
      return false;
    for (; next != samples_.end() && std::prev(next)->time < end; ++next) {
      if (next->time - std::prev(next)->time > kLongestPause)
        return false;
    }
    return end - std::prev(next)->time <= kLongestPause;
  }

  /// Interpolated; after the newest sample, the newest. Only if they cover the time.
  InertialSample at(double time) const {
    const auto next = after(time);
    const InertialSample& last = *std::prev(next);
    if (next == samples_.end())
      return {time, last.rate, last.force};
    const double share = (time - last.time) / (next->time - last.time);
    return {time, last.rate + share * (next->rate - last.rate),
            last.force + share * (next->force - last.force)};
  }

  /// Time of the first sample after a time; infinity without [s].
  double nextAfter(double time) const {
    const auto next = after(time);
    return next == samples_.end() ? std::numeric_limits<double>::infinity() : next->time;
  }

  /// Of the samples; 0 for fewer than two [Hz].
  double frequency() const {
    return samples_.size() < 2 ? 0.0
                               : static_cast<double>(samples_.size() - 1) /
                                     (samples_.back().time - samples_.front().time);
  }

 private:
  static constexpr double kKept = 2.0;           // [s]
  static constexpr double kLongestPause = 0.05;  // [s]

  std::vector<InertialSample>::const_iterator after(double time) const {
    return std::upper_bound(samples_.begin(), samples_.end(), time,
                            [](double t, const InertialSample& sample) { return t < sample.time; });
  }

  Eigen::Vector3d place_;
  std::vector<InertialSample> samples_;  // sorted by time
};

}  // namespace wiimote_tracker::body
