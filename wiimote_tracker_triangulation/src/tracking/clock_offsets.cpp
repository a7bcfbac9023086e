#include "clock_offsets.h"

#include <wiimote_tracker_msgs/median.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace wiimote_tracker::tracking {
namespace {

constexpr double kUnknown = 0.005;  // standard deviation of an offset before any motion [s]
constexpr double kChange = 0.0002;  // the same of its change between two updates [s]
constexpr double kLargest = 0.06;   // [s]; larger ones do not fit at all

// A clock whose time offset the rig knows is corrected when it is off by the first of these, and
// until it is off by less than the second [s]. Less may be an error of the calibration.
constexpr double kCorrected = 0.001;
constexpr double kStaysCorrected = 0.0005;

constexpr double kSpots = 250.0;  // of a camera between two updates: 2.5 s of one LED

double squared(double x) {
  return x * x;
}

}  // namespace

/// What is known of the clock in an epoch, which may be another one.
ClockOffsets::Clock ClockOffsets::Clock::in(std::uint32_t other_epoch, bool is_known_there) const {
  if (epoch == other_epoch && is_known == is_known_there)
    return *this;
  if (is_known && is_known_there)
    return {other_epoch, true, error, is_corrected};
  const ClockError unseen{0.0, is_known_there ? 0.0 : squared(kUnknown)};
  return {other_epoch, is_known_there, unseen, !is_known_there};
}

/// Kalman update by the remainder, if there is one. @param common what all cameras have of it
void ClockOffsets::Clock::updateError(const ClockError& common) {
  if (!remainder)
    return;
  const double measured = correction().offset + remainder->offset - common.offset;
  const double innovation = measured - error.offset;
  if (squared(innovation) <= 4.0 * remainder->bias)
    return;  // it may be the calibration's, which does not average out
  const double noise = remainder->variance + remainder->bias + common.variance;
  double variance = error.variance + squared(kChange);
  if (squared(innovation) > 9.0 * (variance + noise))  // the clock was set
    variance = squared(innovation);
  const double gain = variance / (variance + noise);
  error.offset += gain * innovation;
  error.variance = (1.0 - gain) * variance;
}

void ClockOffsets::Clock::setOffset(double seconds) {
  error.offset = std::clamp(seconds, -kLargest, kLargest);
  const double least = is_corrected ? kStaysCorrected : kCorrected;
  is_corrected = !is_known || std::abs(error.offset) >= least;
}

ClockOffsets::ClockOffsets(const std::vector<std::size_t>& members) {
  for (const std::size_t member : members)
    clocks_[member];
  offsets_.reserve(members.size());
}

void ClockOffsets::enterEpoch(std::size_t camera, std::uint32_t epoch, bool is_known) {
  Clock& clock = clocks_.at(camera);
  if (clock.epoch == epoch && clock.is_known == is_known)
    return;
  clock = clock.in(epoch, is_known);
  ++version_;
}

void ClockOffsets::update(const CameraStates& cameras) {
  const auto hasSeenMotion = [](const auto& camera) {
    return camera.second.offset_regression.count() >= kSpots;
  };
  if (std::none_of(cameras.begin(), cameras.end(), hasSeenMotion))
    return;
  for (const auto& [camera, state] : cameras)
    clocks_.at(camera).remainder = state.fit.isMisfit()
                                       ? std::nullopt
                                       : state.offset_regression.estimate(turn_stddevs_[camera]);
  const ClockError common = commonRemainder();
  for (auto& [camera, clock] : clocks_)
    clock.updateError(common);
  const double median = medianOffset();
  for (auto& [camera, clock] : clocks_)
    clock.setOffset(clock.error.offset - median);
  ++version_;
}

/// By how much all cameras seem to be off, where the predictions lag behind the LEDs.
ClockError ClockOffsets::commonRemainder() {
  offsets_.clear();
  double variances = 0.0;
  for (const auto& [camera, clock] : clocks_) {
    if (!clock.remainder || !isReference(clock))
      continue;
    offsets_.push_back(clock.remainder->offset);
    variances += clock.remainder->variance + clock.remainder->bias;
  }
  if (offsets_.empty())
    return {};
  return {medianOf(&offsets_), variances / squared(static_cast<double>(offsets_.size()))};
}

double ClockOffsets::medianOffset() {
  offsets_.clear();
  for (const auto& [camera, clock] : clocks_) {
    if (isReference(clock))
      offsets_.push_back(clock.error.offset);
  }
  return medianOf(&offsets_);
}

/// Whether medians count it: a known one, or any if none is known.
bool ClockOffsets::isReference(const Clock& clock) const {
  return clock.is_known || std::none_of(clocks_.begin(), clocks_.end(),
                                        [](const auto& other) { return other.second.is_known; });
}

}  // namespace wiimote_tracker::tracking
