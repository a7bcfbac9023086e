#pragma once

#include "wiimote_tracker_driver/exposure_clock/exposure_clock.h"

#include <ros/time.h>

#include <cstdint>

namespace wiimote_tracker::driver {

/// The same instant on the steady clock and on the clock of ROS.
struct ClockReading {
  double steady = 0.0;  ///< [s]
  ros::Time ros;
  double uncertainty = 0.0;  ///< Largest time between the two readings [s].
  bool simulated = false;    ///< ROS time is simulated (use_sim_time).
};

/// The times in an image's message.
struct ImageTime {
  ros::Time stamp;      ///< Best estimate of the exposure; increases within an epoch.
  ros::Time arrival;    ///< On the same clock.
  double stddev = 0.0;  ///< Of the stamp [s]; NaN when it is just the arrival less the latency.
  std::uint32_t clock_epoch = 0;
  /// Counts images, including those known to be lost. If an image was wrongly counted as lost,
  /// later losses are not counted instead.
  std::uint64_t frame = 0;
};

/// Times of the images of one remote. Exposures are estimated on the steady clock and converted to
/// ROS time by the offset of the two clocks. The offset follows the clocks' drift slowly, because a
/// single reading is wrong when the thread is interrupted between the two clocks; until then the
/// deviation is part of the stated error. A step of the system clock begins a new epoch, in which
/// times may be earlier than before.
class ImageStamper {
 public:
  struct Options {
    double latency = 0.0;  ///< Constant part of the delay, subtracted [s].
    bool estimate = true;  ///< Else stamps are arrivals less the latency.
    double period = exposure_clock::kNominalPeriod;  ///< Between images [s].
  };

  /// Sums since the beginning, over all epochs.
  struct Totals {
    std::int64_t dropped = 0;
    std::uint64_t stale = 0;
    std::uint64_t clock_steps = 0;
  };

  explicit ImageStamper(const Options& options);

  /// An image arrived when `now` was read; before, if it `waited`. `device_epoch`: increases at
  /// each reconnect.
  ImageTime stamp(const ClockReading& now, std::uint32_t device_epoch, bool waited = false);

  /// Of the present epoch.
  exposure_clock::Statistics statistics() const { return clock_.statistics(); }
  Totals totals() const;

 private:
  bool rosClockStepped(const ClockReading& now) const;
  void beginEpoch(const ClockReading& now);
  void followRosClock(const ClockReading& now);

  Options options_;
  exposure_clock::ExposureClock clock_;
  // Last arrival on both clocks.
  double steady_arrival_ = 0.0;
  ros::Time ros_arrival_;
  double deviation_ = 0.0;  ///< Of ros_arrival_ from the clock, not yet followed [s].
  ros::Time last_stamp_;
  bool any_image_ = false;
  std::uint32_t device_epoch_ = 0;
  std::uint64_t frame_ = 0;
  std::uint64_t epoch_frame_ = 0;  ///< Of the epoch's first image.
  Totals before_;                  ///< Of the epochs before this one.
};

}  // namespace wiimote_tracker::driver
