// A reader that is late, as on a busy computer: of a report that waited for it the clock knows only
// that its image is older.
#include "wiimote_tracker_driver/exposure_clock/exposure_clock.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace wiimote_tracker::exposure_clock {
namespace {

constexpr double kCameraPeriod = 0.010035;

/// Reads reports with exponential delays of mean 2 ms, none lost on the way, from time 0.
struct Reader {
  explicit Reader(int reports) {
    while (frame < reports)
      read();
  }
  /// @param least time that it needs [s].
  void read(double least = 1e-4) {
    arrival = std::max(arrival, time() + delay(random));
    now = std::max(now + least, arrival);
    const bool waited = now > arrival + 0.002;
    estimate = clock.update(now, waited);
    error = std::abs(estimate.exposure - time());
    ++frame;
  }
  /// Nothing is read for so long [s]; then what waits.
  void stop(double duration) {
    now += duration;
    while (time() < now)
      read();
  }
  /// Exposure of the next image.
  double time() const { return frame * kCameraPeriod; }

  std::mt19937_64 random{5};
  std::exponential_distribution<double> delay{1.0 / 0.002};
  ExposureClock clock;
  Estimate estimate;
  double error = 0.0;
  double arrival = 0.0, now = 0.0;
  int frame = 0;
};

// A queue grows, and images are up to 0.3 s old.
TEST(ExposureClockOfALateReader, reports_that_waited_keep_their_own_times) {
  Reader reader(1000);
  for (int read = 0; read < 30; ++read) {
    reader.read(0.020);
    EXPECT_LT(reader.error, 2.0 * reader.estimate.stddev + 1e-3) << read;
    EXPECT_LT(reader.estimate.stddev, 0.030) << read;
  }
}

TEST(ExposureClockOfALateReader, its_delays_are_not_learnt_as_stalls_of_the_link) {
  Reader reader(1000);
  for (int i = 0; i < 100; ++i) {
    reader.stop(0.08);
    for (int read = 0; read < 20; ++read)
      reader.read();
  }
  int taken_for_late = 0;
  for (int i = 0; i < 20; ++i) {
    reader.frame += 3;  // lost
    reader.read();
    taken_for_late += reader.error > 0.5 * kCameraPeriod;
    for (int read = 0; read < 20; ++read)
      reader.read();
  }
  EXPECT_LE(taken_for_late, 4);
}

TEST(ExposureClockOfALateReader, the_clock_does_not_begin_anew_with_a_report_that_waited) {
  Reader reader(1000);
  reader.frame += 600;
  reader.now = reader.time();
  reader.now += 0.3;
  reader.read();
  EXPECT_LT(reader.error, 2.0 * reader.estimate.stddev);
  while (reader.time() < reader.now)
    reader.read();
  for (int read = 0; read < 100; ++read)
    reader.read();
  EXPECT_LT(reader.error, 1e-3);
}

}  // namespace
}  // namespace wiimote_tracker::exposure_clock
