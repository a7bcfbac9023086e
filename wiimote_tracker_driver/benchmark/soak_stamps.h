#pragma once

#include "ros/image_stamper.h"
#include "trials.h"

#include <cstdint>
#include <optional>
#include <random>

namespace wiimote_tracker {

/// A computer's clock beside its steady clock: 100 ppm fast, set right every day at noon by a step,
/// with a leap second at the first midnight after `leap_after` [s]. On the sixth day its seconds
/// since 1970 pass 2^31.
class DriftingClock {
 public:
  /// `day`: of how many seconds.
  DriftingClock(double day, double leap_after);

  /// @param steady [s, >= 0]
  ros::Time at(double steady) const;
  /// Steps until then.
  std::uint64_t steps(double steady) const;

  static constexpr double kRate = 1.0001;

 private:
  ros::Time begin_;
  double day_;   // [s]
  double leap_;  // [s]
};

/// Stamps images as the driver does, and compares the stamps with the true exposures. Reports are
/// delayed by 2 ms and an exponential of 0.5 ms; two of 1000 are lost; some wait for 0.2 s.
class SoakStamps {
 public:
  /// `settling`: images so long after the beginning of an epoch are not judged [s].
  SoakStamps(const DriftingClock& clock, double settling);

  /// @param exposure on the steady clock [s]. @param device_epoch as of wiimote::Link.
  void add(double exposure, std::uint32_t device_epoch);

  Results results() const;

 private:
  bool chance(double probability);
  void judge(const driver::ImageTime& time, double error);

  const DriftingClock clock_;
  const double settling_;
  driver::ImageStamper stamper_;
  std::mt19937_64 random_{1};
  double arrival_ = 0.0;  // of the newest image [s]
  std::optional<driver::ImageTime> before_;
  double epoch_begin_ = 0.0;  // [s]

  std::uint64_t judged_ = 0;
  std::uint64_t wrong_ = 0;           // off by 1 ms and by five standard deviations
  std::uint64_t not_increasing_ = 0;  // stamps in an epoch, and frame numbers
  double squared_ = 0.0;              // errors [s^2]
  double worst_ = 0.0;                // error [s]
};

}  // namespace wiimote_tracker
