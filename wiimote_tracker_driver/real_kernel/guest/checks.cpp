#include "checks.h"

#include "clock.h"
#include "recovery.h"

#include <wiimote_tracker_msgs/text.h>

#include <algorithm>
#include <cstdio>
#include <limits>

namespace wiimote_tracker::real_kernel {
namespace {

constexpr double kLongestRecovery = 1.0;  // [s]
// A stream that has not recovered by then counts as lost [s].
constexpr double kRecoveryTimeout = 15.0;
// Increment between the moments of repeated disturbances [s]; no multiple of the remote's 10 ms.
constexpr double kShift = 0.0137;

struct Recovery {
  double time = 0.0;   ///< [s] Infinite when there was none.
  double pause = 0.0;  ///< [s] Longest without an image meanwhile.
};

Recovery waitForRecovery(const RunningDriver& driver, double since) {
  Recovery recovery;
  const bool recovered = waitFor(
      [&] {
        return (recovery.time = recoveryTime(driver.images(), since, driver.recoveryRate())) >= 0.0;
      },
      kRecoveryTimeout);
  if (recovered)
    recovery.pause = longestPause(driver.images(), since, since + recovery.time + kRecoveryWindow);
  else
    recovery.time = std::numeric_limits<double>::infinity();
  return recovery;
}

std::string describe(const Recovery& recovery, const RunningDriver& driver) {
  if (recovery.time <= kRecoveryTimeout)
    return "back within " + seconds(recovery.time) + ", longest pause " + seconds(recovery.pause);
  const std::string reason = driver.link().error;
  return "no stream within " + seconds(kRecoveryTimeout) + "; " +
         (reason.empty() ? "the driver gives no reason" : reason);
}

}  // namespace

std::string seconds(double value) {
  return format("%.3f s", value);
}

void Checks::check(const std::string& name, bool passed, const std::string& seen) {
  ++count_;
  failed_ += passed ? 0 : 1;
  std::printf("CHECK %s|%s|%s\n", passed ? "passed" : "failed", name.c_str(), seen.c_str());
  std::fflush(stdout);
}

void Checks::skip(const std::string& name, const std::string& reason) {
  ++count_;
  std::printf("CHECK skipped|%s|%s\n", name.c_str(), reason.c_str());
  std::fflush(stdout);
}

void Checks::recovers(const std::string& name,
                      const RunningDriver& driver,
                      const std::function<void()>& disturb,
                      int times) {
  Recovery worst;
  for (int i = 0; i < times; ++i) {
    sleepFor(kShift * i);
    const double since = now();
    disturb();
    const Recovery recovery = waitForRecovery(driver, since);
    worst.time = std::max(worst.time, recovery.time);
    worst.pause = std::max(worst.pause, recovery.pause);
    if (worst.time > kRecoveryTimeout)
      break;
  }
  check(name, worst.time <= kLongestRecovery,
        (times > 1 ? std::to_string(times) + " times, " : "") + describe(worst, driver));
}

void Checks::restores(const std::string& name,
                      const RunningDriver& driver,
                      const std::function<void()>& disturb,
                      const std::string& found,
                      double within) {
  const std::uint64_t before = driver.link().restorations;
  const double since = now();
  disturb();
  waitFor([&] { return driver.link().restorations > before; }, kRecoveryTimeout);
  const double restored = now();
  const wiimote::Link link = driver.link();
  check(name + ": found and put right",
        link.restorations == before + 1 && link.last_restoration == found &&
            restored - since <= within,
        "after " + seconds(restored - since) + ", " + std::to_string(link.restorations - before) +
            " times: " + link.last_restoration);
  recoversFrom(name, driver, restored);
}

void Checks::recoversFrom(const std::string& name, const RunningDriver& driver, double since) {
  const Recovery recovery = waitForRecovery(driver, since);
  check(name, recovery.time <= kLongestRecovery, describe(recovery, driver));
}

void Checks::streams(const std::string& kind, const RunningDriver& driver, double duration) {
  const double begin = now();
  sleepFor(duration);
  const double end = now();
  const std::vector<double> images = driver.images();
  const std::size_t in_time = imagesBetween(images, begin, end);
  check(format("%s%g s at %g Hz or more", kind.c_str(), duration, driver.recoveryRate()),
        static_cast<double>(in_time) >= driver.recoveryRate() * duration, count(in_time, "images"));
  const double pause = longestPause(images, begin, end);
  check(kind + "no pause of 0.1 s or more", pause < 0.1, "longest " + seconds(pause));
}

void Checks::streamForLong(const std::deque<RunningDriver>& drivers) {
  const double begin = now();
  sleepFor(5.0);
  for (std::size_t i = 0; i < drivers.size(); ++i) {
    const std::size_t in_time = imagesBetween(drivers[i].images(), begin, now());
    check("remote " + std::to_string(i + 1) + ": 5 s at 90 Hz or more", in_time >= 450,
          count(in_time, "images"));
  }
}

std::string count(std::size_t number, const std::string& things) {
  return std::to_string(number) + " " + things;
}

}  // namespace wiimote_tracker::real_kernel
