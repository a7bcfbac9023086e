#include "image_stamper.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace wiimote_tracker::driver {
namespace {

// Smallest deviation that counts as a step of the system clock [s]; less is jitter or drift.
constexpr double kStep = 0.005;
// Readings less certain than this do not correct the drift [s].
constexpr double kMaxClockUncertainty = 1e-4;
// Share of a deviation that is corrected at each image: a time constant of 100 images, one second.
constexpr double kDriftGain = 0.01;
// Shortest time between two stamps.
const ros::Duration kLeastStep(1e-6);

// ros::Time cannot be negative, and simulated time begins at 0.
ros::Time subtract(const ros::Time& time, double seconds) {
  return time.toSec() > seconds ? time - ros::Duration(seconds) : time;
}

}  // namespace

ImageStamper::ImageStamper(const Options& options) : options_(options), clock_(options.period) {}

ImageTime ImageStamper::stamp(const ClockReading& now, std::uint32_t device_epoch, bool waited) {
  const bool stepped = any_image_ && rosClockStepped(now);
  if (!any_image_ || stepped || device_epoch != device_epoch_)
    beginEpoch(now);
  else
    followRosClock(now);
  before_.clock_steps += stepped ? 1 : 0;
  device_epoch_ = device_epoch;

  const exposure_clock::Estimate estimate = clock_.update(now.steady, waited);
  ImageTime time;
  time.arrival = ros_arrival_;
  time.stddev = std::numeric_limits<double>::quiet_NaN();
  double age = options_.latency;
  // In simulated time the steady clock does not measure the age.
  if (options_.estimate && !now.simulated) {
    age += now.steady - estimate.exposure;
    time.stddev = std::hypot(estimate.stddev, deviation_);
  }
  time.stamp = subtract(time.arrival, age);
  if (any_image_)
    frame_ = std::max(frame_ + 1, epoch_frame_ + static_cast<std::uint64_t>(estimate.frame));
  if (!last_stamp_.isZero())
    time.stamp = std::max(time.stamp, last_stamp_ + kLeastStep);
  last_stamp_ = time.stamp;
  time.frame = frame_;
  time.clock_epoch = device_epoch + static_cast<std::uint32_t>(before_.clock_steps);
  any_image_ = true;
  return time;
}

bool ImageStamper::rosClockStepped(const ClockReading& now) const {
  if (now.simulated)
    return now.ros < ros_arrival_;
  // In seconds: ros::Duration throws beyond 68 years.
  const double deviation = now.ros.toSec() - ros_arrival_.toSec() - (now.steady - steady_arrival_);
  return std::abs(deviation) > kStep + now.uncertainty;
}

void ImageStamper::beginEpoch(const ClockReading& now) {
  before_ = totals();
  clock_.reset();
  steady_arrival_ = now.steady;
  ros_arrival_ = now.ros;
  deviation_ = 0.0;
  last_stamp_ = ros::Time();
  epoch_frame_ = any_image_ ? frame_ + 1 : 0;
}

void ImageStamper::followRosClock(const ClockReading& now) {
  const double interval = now.steady - steady_arrival_;
  if (now.simulated) {
    ros_arrival_ = now.ros;
  } else {
    const double deviation = (now.ros - ros_arrival_).toSec() - interval;
    ros_arrival_ += ros::Duration(interval);
    if (now.uncertainty < kMaxClockUncertainty) {
      ros_arrival_ += ros::Duration(kDriftGain * deviation);
      deviation_ = (1.0 - kDriftGain) * deviation;
    }
  }
  steady_arrival_ = now.steady;
}

ImageStamper::Totals ImageStamper::totals() const {
  const exposure_clock::Statistics now = clock_.statistics();
  Totals totals = before_;
  totals.dropped += now.dropped;
  totals.stale += now.stale;
  return totals;
}

}  // namespace wiimote_tracker::driver
