#include "camera_clocks.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace wiimote_tracker::tracking {
namespace {

constexpr double kUnknown = 0.005;  // standard deviation of an offset before any motion [s]
constexpr double kChange = 0.0002;  // the same of its change between two updates [s]
constexpr double kLargest = 0.06;   // [s]; larger ones do not fit at all

// Smaller offsets of a clock that should be right may come from the calibration; half of it for one
// that is corrected already [s].
constexpr double kNoticeable = 0.001;

constexpr double kSpots = 250.0;  // of a camera between two updates: 2.5 s of one LED

double squared(double x) {
  return x * x;
}

}  // namespace

ClockRegression::Estimate CameraClocks::correctionOf(std::size_t camera,
                                                     std::uint32_t epoch,
                                                     bool is_known) {
  Clock& clock = clocks_[camera];
  if (clock.epoch != epoch || clock.is_known != is_known) {
    clock = clock.in(epoch, is_known);
    ++version_;
  }
  return clock.correction();
}

/// What is known of the clock in an epoch, which may be another one.
CameraClocks::Clock CameraClocks::Clock::in(std::uint32_t another_epoch,
                                            bool is_known_there) const {
  if (is_known && is_known_there)
    return {another_epoch, true, is_used, offset};
  if (epoch == another_epoch && is_known == is_known_there)
    return *this;
  return {another_epoch,
          is_known_there,
          !is_known_there,
          {0.0, is_known_there ? 0.0 : squared(kUnknown)}};
}

double CameraClocks::errorIn(std::size_t camera, std::uint32_t epoch, bool is_known) const {
  return clocks_[camera].in(epoch, is_known).correction().offset;
}

double CameraClocks::errorOf(std::size_t camera) const {
  const Clock& clock = clocks_[camera];
  return clock.is_known ? clock.correction().offset : 0.0;
}

/// By how much all cameras seem to be off, where the predictions lag behind the LEDs.
ClockRegression::Estimate CameraClocks::commonRemainder() {
  double variances = 0.0;
  double count = 0.0;
  const double common = medianOf([&](std::size_t i) -> std::optional<double> {
    const auto& remainder = remainders_[i];
    if (!remainder)
      return std::nullopt;
    variances += remainder->variance + remainder->bias;
    count += 1.0;
    return remainder->offset;
  });
  return {common, count > 0.0 ? variances / (count * count) : 0.0};
}

void CameraClocks::update(const std::vector<CameraFit>& fits,
                          const std::vector<ClockRegression>& regressions) {
  if (std::none_of(regressions.begin(), regressions.end(),
                   [](auto& regression) { return regression.count() >= kSpots; }))
    return;
  for (std::size_t i = 0; i < fits.size(); ++i)
    remainders_[i] = fits[i].isMisfit() ? std::nullopt : regressions[i].estimate(turn_stddevs_[i]);
  const ClockRegression::Estimate common = commonRemainder();
  for (std::size_t i = 0; i < fits.size(); ++i) {
    const auto& remainder = remainders_[i];
    if (!remainder)
      continue;
    ClockRegression::Estimate& offset = clocks_[i].offset;
    const double seen = clocks_[i].correction().offset + remainder->offset - common.offset;
    const double innovation = seen - offset.offset;
    if (squared(innovation) <= 4.0 * remainder->bias)
      continue;  // it may be the calibration's, which does not average out
    const double seen_variance = remainder->variance + remainder->bias + common.variance;
    double variance = offset.variance + squared(kChange);
    if (squared(innovation) > 9.0 * (variance + seen_variance))  // the clock was set
      variance = squared(innovation);
    const double gain = variance / (variance + seen_variance);
    offset.offset += gain * innovation;
    offset.variance = (1.0 - gain) * variance;
  }
  const double middle =
      medianOf([&](std::size_t i) { return std::make_optional(clocks_[i].offset.offset); });
  for (Clock& clock : clocks_) {
    clock.offset.offset = std::clamp(clock.offset.offset - middle, -kLargest, kLargest);
    clock.is_used = !clock.is_known ||
                    std::abs(clock.offset.offset) >= (clock.is_used ? 0.5 : 1.0) * kNoticeable;
  }
  ++version_;
}

/// The median of a value of each known clock, or of all if none is known [s]. @param value_of the
/// camera at an index; nothing: left out
template <typename ValueOf>
double CameraClocks::medianOf(const ValueOf& value_of) {
  const bool none_known =
      std::none_of(clocks_.begin(), clocks_.end(), [](auto& clock) { return clock.is_known; });
  std::size_t count = 0;
  for (std::size_t i = 0; i < clocks_.size(); ++i) {
    const std::optional<double> value =
        clocks_[i].is_known || none_known ? value_of(i) : std::nullopt;
    if (value)
      sorted_[count++] = *value;
  }
  if (count == 0)
    return 0.0;
  std::sort(sorted_.begin(), sorted_.begin() + count);
  return 0.5 * (sorted_[(count - 1) / 2] + sorted_[count / 2]);
}

}  // namespace wiimote_tracker::tracking
