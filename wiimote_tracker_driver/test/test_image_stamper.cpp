// Stamps of images, with clocks controlled by the test.
#include "ros/image_stamper.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace wiimote_tracker::driver {
namespace {

constexpr double kPeriod = 0.010035;     // [s]
constexpr double kDelay = 0.006;         // [s] Least time from exposure to arrival.
constexpr double kSteadyStart = 5000.0;  // [s]
const ros::Time kRosStart(1700000000, 0);

/// A remote whose images arrive at least kDelay after their exposures, and a computer that reads
/// them.
class ImageStamperTest : public testing::Test {
 protected:
  /// Exposure of image n on the clock of ROS.
  ros::Time exposure(int n) const { return kRosStart + step_ + ros::Duration(n * period_); }

  /// Takes image n.
  ImageTime take(int n, double more_delay = 0.0) {
    const double time = n * period_ + kDelay + more_delay;
    ClockReading now;
    now.steady = kSteadyStart + time;
    now.uncertainty = uncertainty_;
    now.ros = kRosStart + step_ + ros::Duration(time + misreading_);
    now.simulated = simulated_;
    return stamper_.stamp(now, device_epoch_);
  }

  double softDelay() { return std::abs(std::normal_distribution<double>(0.0, 0.001)(random_)); }

  void make(const ImageStamper::Options& options) { stamper_ = ImageStamper(options); }

  double period_ = kPeriod;
  ros::Duration step_{0.0};    ///< By which the system clock was set.
  double misreading_ = 0.0;    ///< [s] From an interruption between reading the two clocks.
  double uncertainty_ = 1e-6;  ///< [s]
  bool simulated_ = false;
  std::uint32_t device_epoch_ = 0;
  std::mt19937 random_{5};
  ImageStamper stamper_{ImageStamper::Options()};
};

TEST_F(ImageStamperTest, StampsAreExposuresUpToTheLeastDelay) {
  std::exponential_distribution<double> late(1.0 / 0.0005);
  for (int n = 0; n < 2000; ++n) {
    const double delay = late(random_);
    const ImageTime time = take(n, delay);
    ASSERT_NEAR(kDelay + delay, (time.arrival - exposure(n)).toSec(), 1e-6);
    ASSERT_EQ(static_cast<std::uint64_t>(n), time.frame);
    if (n < 1000)
      continue;
    ASSERT_NEAR(kDelay, (time.stamp - exposure(n)).toSec(), 0.0005) << n;
    ASSERT_LT(time.stddev, 0.001);
  }
}

TEST_F(ImageStamperTest, ARemoteMayBeFastOrSlow) {
  for (const double period : {0.00999, 0.0100, 0.01008, 0.0101}) {
    period_ = period;
    make(ImageStamper::Options());
    for (int n = 0; n < 3000; ++n) {
      const ImageTime time = take(n, softDelay());
      if (n > 1500) {
        ASSERT_NEAR(kDelay, (time.stamp - exposure(n)).toSec(), 0.001) << period << ", " << n;
      }
    }
    EXPECT_NEAR(period, stamper_.statistics().period, 1e-5);
  }
}

TEST_F(ImageStamperTest, LatencyIsSubtracted) {
  ImageStamper::Options options;
  options.latency = kDelay;
  make(options);
  ImageTime time;
  for (int n = 0; n < 500; ++n)
    time = take(n);
  EXPECT_NEAR(0.0, (time.stamp - exposure(499)).toSec(), 1e-4);
}

TEST_F(ImageStamperTest, FullModeHasHalfTheRate) {
  period_ = 2.0 * kPeriod;
  ImageStamper::Options options;
  options.period *= 2.0;
  make(options);
  ImageTime time;
  for (int n = 0; n < 1000; ++n) {
    time = take(n, softDelay());
    ASSERT_EQ(static_cast<std::uint64_t>(n), time.frame);
  }
  EXPECT_EQ(0, stamper_.totals().dropped);
  EXPECT_NEAR(period_, stamper_.statistics().period, 1e-5);
}

TEST_F(ImageStamperTest, WithoutEstimateAStampIsTheArrivalLessTheLatency) {
  ImageStamper::Options options;
  options.estimate = false;
  options.latency = 0.004;
  make(options);
  for (int n = 0; n < 100; ++n) {
    const ImageTime time = take(n, softDelay());
    ASSERT_NEAR(0.004, (time.arrival - time.stamp).toSec(), 1e-8);
    ASSERT_TRUE(std::isnan(time.stddev));
  }
}

TEST_F(ImageStamperTest, LostImagesAreGapsInTheCount) {
  std::uint64_t expected = 0;
  for (int n = 0; n < 1000; ++n) {
    if (n >= 550 && n % 50 < 2)  // two of fifty
      continue;
    const ImageTime time = take(n);
    expected = static_cast<std::uint64_t>(n);
    ASSERT_EQ(expected, time.frame);
  }
  EXPECT_EQ(18, stamper_.totals().dropped);
}

TEST_F(ImageStamperTest, AFalseLossLeavesNoPermanentGap) {
  // With such delays a late report looks like one after a loss, until others follow.
  std::exponential_distribution<double> late(1.0 / 0.005);
  std::bernoulli_distribution lost(0.05);
  double arrival = 0.0;
  std::uint64_t last = 0;
  int too_high = 0, images = 0, ahead_at_end = 100;
  for (int n = 0; n < 6000; ++n) {
    if (n > 0 && lost(random_))
      continue;
    arrival = std::max(arrival, n * period_ + late(random_));
    const ImageTime time = take(n, arrival - n * period_);
    if (n > 0) {
      ASSERT_LT(last, time.frame);
    }
    last = time.frame;
    ahead_at_end = static_cast<int>(time.frame) - n;
    too_high += ahead_at_end > 2;
    ++images;
  }
  EXPECT_LT(too_high, 0.02 * images);
  EXPECT_LE(std::abs(ahead_at_end), 2);
}

TEST_F(ImageStamperTest, DelayedReportsGetTheirOwnTimes) {
  for (int n = 0; n < 500; ++n)
    take(n, softDelay());
  // The reader stalls for 200 ms; waiting reports then come at once.
  for (int n = 500; n < 520; ++n) {
    const ImageTime time = take(n, (520 - n) * kPeriod + 0.0001 * (n - 500));
    EXPECT_NEAR(kDelay, (time.stamp - exposure(n)).toSec(), 0.001) << n;
  }
  EXPECT_GE(stamper_.totals().stale, 15u);
  EXPECT_LE(stamper_.totals().stale, 20u);
}

TEST_F(ImageStamperTest, InterruptedReadingsOfTheClocksDoNotShowInTheStamps) {
  for (int n = 0; n < 2000; ++n) {
    const bool interrupted = n % 10 == 5;
    misreading_ = interrupted ? 0.003 : 0.0;
    uncertainty_ = interrupted ? 0.0035 : 1e-6;
    const ImageTime time = take(n);
    ASSERT_NEAR(kDelay, (time.arrival - exposure(n)).toSec(), 1e-6) << n;
  }
  EXPECT_EQ(0u, stamper_.totals().clock_steps);
}

TEST_F(ImageStamperTest, SlowDriftOfTheClocksIsFollowed) {
  ImageTime time;
  for (int n = 0; n < 5000; ++n) {
    misreading_ = 100e-6 * n * kPeriod;  // 100 ppm
    time = take(n);
  }
  EXPECT_EQ(0u, time.clock_epoch);
  EXPECT_NEAR(kDelay + misreading_, (time.arrival - exposure(4999)).toSec(), 0.0002);
}

TEST_F(ImageStamperTest, ASmallStepIsPartOfTheStatedErrorUntilItIsFollowed) {
  int n = 0;
  while (n < 2000)
    take(n++);
  step_ = ros::Duration(0.004);
  for (const int last = n + 1000; n < last; ++n) {
    const ImageTime time = take(n);
    EXPECT_EQ(0u, time.clock_epoch);
    EXPECT_LT(std::abs((time.stamp - exposure(n)).toSec() - kDelay), 2.0 * time.stddev) << n;
  }
  EXPECT_LT(take(n).stddev, 0.001);
}

TEST_F(ImageStamperTest, ASetSystemClockIsANewEpoch) {
  for (const double step : {3600.0, -3600.0, -0.02}) {
    ImageTime before;
    int n = 0;
    for (; n < 200; ++n)
      before = take(n);
    step_ += ros::Duration(step);
    const ImageTime after = take(n);
    EXPECT_EQ(before.clock_epoch + 1, after.clock_epoch) << step;
    EXPECT_EQ(before.frame + 1, after.frame) << step;
    EXPECT_NEAR(kDelay, (after.arrival - exposure(n)).toSec(), 1e-6) << step;
    EXPECT_NEAR(kDelay, (after.stamp - exposure(n)).toSec(), kPeriod) << step;
    make(ImageStamper::Options());
  }
}

TEST_F(ImageStamperTest, AClockThatWasWrongByACenturyMayBeSet) {
  const ros::Time past(100000000, 0), future(4200000000u, 0);
  ClockReading now;
  std::uint32_t epoch = 0;
  for (const ros::Time& set : {future, past, future}) {
    now.steady += 1.0;
    now.ros = set;
    const ImageTime time = stamper_.stamp(now, 0);
    EXPECT_EQ(epoch++, time.clock_epoch);
    EXPECT_EQ(set, time.arrival);
  }
}

TEST_F(ImageStamperTest, SimulatedTimeMayLeapByACentury) {
  ClockReading now;
  now.simulated = true;
  for (const ros::Time& time : {ros::Time(1, 0), ros::Time(4200000000u, 0)}) {
    now.steady += 1.0;
    now.ros = time;
    const ImageTime image = stamper_.stamp(now, 0);
    EXPECT_EQ(0u, image.clock_epoch);
    EXPECT_EQ(time, image.stamp);
  }
}

TEST_F(ImageStamperTest, AReconnectIsANewEpochThatStartsUncertain) {
  ImageTime time;
  for (int n = 0; n < 501; ++n) {
    if (n != 400)
      time = take(n);
  }
  EXPECT_LT(time.stddev, 0.001);
  ++device_epoch_;
  time = take(700, 0.003);
  EXPECT_EQ(1u, time.clock_epoch);
  EXPECT_EQ(501u, time.frame) << "images while it was away are not lost ones";
  EXPECT_GT(time.stddev, 0.001);
  EXPECT_EQ(1, stamper_.totals().dropped) << "over all epochs";
}

// Property: whatever the delays, losses, steps and reconnects.
TEST_F(ImageStamperTest, StampsIncreaseWithinAnEpochAndFramesAlways) {
  for (int trial = 0; trial < 20; ++trial) {
    make(ImageStamper::Options());
    const auto chance = [&](double p) { return std::bernoulli_distribution(p)(random_); };
    std::exponential_distribution<double> late(1.0 / 0.004);
    double queued_until = 0.0;
    ImageTime last;
    for (int n = 0; n < 1000; ++n) {
      if (chance(0.05))
        continue;
      if (chance(0.005))
        step_ += ros::Duration(chance(0.5) ? 1.0 : -1.0);
      device_epoch_ += chance(0.003) ? 1 : 0;
      const double delay = late(random_) + (chance(0.01) ? 0.15 : 0.0);
      queued_until = std::max(queued_until + 1e-5, n * period_ + delay);
      const ImageTime time = take(n, queued_until - n * period_);
      if (n > 0 && last.clock_epoch == time.clock_epoch && !last.stamp.isZero()) {
        ASSERT_LT(last.stamp, time.stamp);
      }
      if (!last.stamp.isZero()) {
        ASSERT_LT(last.frame, time.frame);
        ASSERT_LE(last.clock_epoch, time.clock_epoch);
      }
      last = time;
    }
  }
}

TEST_F(ImageStamperTest, SimulatedTimeIsNotMixedWithTheSteadyClock) {
  simulated_ = true;
  ImageTime time;
  for (int n = 0; n < 100; ++n) {
    step_ += ros::Duration(0.05);  // six times as fast as real time
    time = take(n);
    ASSERT_EQ(time.arrival, time.stamp);
    ASSERT_TRUE(std::isnan(time.stddev));
    ASSERT_EQ(0u, time.clock_epoch);
  }
  const ros::Time before = time.stamp;
  step_ -= ros::Duration(period_);  // time stands still
  EXPECT_LT(before, take(100).stamp);
  step_ -= ros::Duration(1000.0);  // a bag begins again
  EXPECT_EQ(1u, take(101).clock_epoch);
}

}  // namespace
}  // namespace wiimote_tracker::driver
