#include "soak_stamps.h"

#include <algorithm>
#include <cmath>

namespace wiimote_tracker {
namespace {

constexpr double kDelay = 0.002;         // [s]
constexpr double kJitter = 0.0005;       // mean [s]
constexpr double kLost = 0.002;          // share
constexpr double kStalls = 1e-5;         // share
constexpr double kStall = 0.2;           // [s]
constexpr double kInterrupted = 0.001;   // share of the readings of the clocks
constexpr double kInterruption = 0.001;  // [s]
constexpr double kUninterrupted = 1e-6;  // [s]
// Of seconds since 1970, passed at 03:14:08 of a day.
constexpr double kTwoTo31 = 2147483648.0;
constexpr double kHours = 11648.0 / 3600.0;

// A stamp is wrong if it is off by more than both.
constexpr double kWrong = 0.001;  // [s]
constexpr double kClaimed = 5.0;  // its own standard deviations

driver::ImageStamper::Options options() {
  driver::ImageStamper::Options options;
  options.latency = kDelay;
  return options;
}

}  // namespace

DriftingClock::DriftingClock(double day, double leap_after)
    : begin_(kTwoTo31 - day * (5.0 + kHours / 24.0)),
      day_(day),
      leap_(day * std::ceil(leap_after / day)) {}

std::uint64_t DriftingClock::steps(double steady) const {
  return static_cast<std::uint64_t>(std::llround(steady / day_)) + (steady >= leap_ ? 1 : 0);
}

ros::Time DriftingClock::at(double steady) const {
  const double noon = day_ * std::max(0.0, std::floor(steady / day_ + 0.5) - 0.5);
  const double drift = (kRate - 1.0) * (steady - noon);
  // In two parts: a double of seconds since 1970 has steps of 0.2 us.
  return begin_ + ros::Duration(steady + drift - (steady >= leap_ ? 1.0 : 0.0));
}

SoakStamps::SoakStamps(const DriftingClock& clock, double settling)
    : clock_(clock), settling_(settling), stamper_(options()) {}

bool SoakStamps::chance(double probability) {
  return std::uniform_real_distribution<double>(0.0, 1.0)(random_) < probability;
}

void SoakStamps::add(double exposure, std::uint32_t device_epoch) {
  if (chance(kLost))
    return;
  const double delay = kDelay + std::exponential_distribution<double>(1.0 / kJitter)(random_) +
                       (chance(kStalls) ? kStall : 0.0);
  arrival_ = std::max(arrival_, exposure + delay);
  driver::ClockReading now;
  now.steady = arrival_;
  now.uncertainty = chance(kInterrupted) ? kInterruption : kUninterrupted;
  now.ros = clock_.at(arrival_) + ros::Duration(now.uncertainty);
  const driver::ImageTime time = stamper_.stamp(now, device_epoch);
  if (before_ && time.clock_epoch == before_->clock_epoch && time.stamp <= before_->stamp)
    ++not_increasing_;
  if (before_ && time.frame <= before_->frame)
    ++not_increasing_;
  if (!before_ || time.clock_epoch != before_->clock_epoch)
    epoch_begin_ = arrival_;
  before_ = time;
  if (arrival_ - epoch_begin_ >= settling_)
    judge(time, (time.stamp - clock_.at(arrival_)).toSec() +
                    DriftingClock::kRate * (arrival_ - exposure));
}

void SoakStamps::judge(const driver::ImageTime& time, double error) {
  ++judged_;
  wrong_ += std::abs(error) > std::max(kWrong, kClaimed * time.stddev) ? 1 : 0;
  squared_ += error * error;
  worst_ = std::max(worst_, std::abs(error));
}

Results SoakStamps::results() const {
  const auto count = [](std::uint64_t n) { return static_cast<double>(n); };
  const std::uint64_t steps = clock_.steps(arrival_);
  return {{"clock_steps", count(steps), "1"},
          {"clock_steps_not_noticed", count(steps) - count(stamper_.totals().clock_steps), "1"},
          {"times_not_increasing", count(not_increasing_), "1"},
          {"stamp_error_rms", 1e6 * std::sqrt(squared_ / count(judged_)), "us"},
          {"stamp_error_worst", 1e3 * worst_, "ms"},
          {"wrong_stamps", count(wrong_), "1"}};
}

}  // namespace wiimote_tracker
