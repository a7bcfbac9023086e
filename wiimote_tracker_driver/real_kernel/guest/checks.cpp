#include "checks.h"

#include "clock.h"

#include <algorithm>
#include <cstdio>

namespace wiimote_tracker::real_kernel {
namespace {

constexpr double kWindow = 1.0;           // [s]
constexpr std::ptrdiff_t kImages = 90;    // in the window
constexpr double kLongestRecovery = 1.0;  // [s]
// A stream that is not back by then is not coming back by itself [s].
constexpr double kPatience = 15.0;
// Between the moments of repeated disturbances [s]; no multiple of the remote's 10 ms.
constexpr double kShift = 0.0137;

}  // namespace

double recoveryTime(const std::vector<double>& images, double since) {
  for (auto first = std::lower_bound(images.begin(), images.end(), since);
       images.end() - first >= kImages; ++first) {
    if (*(first + kImages - 1) < *first + kWindow)
      return *first - since;
  }
  return -1.0;
}

double longestPause(const std::vector<double>& images, double begin, double end) {
  double last = begin;
  double longest = 0.0;
  for (auto image = std::lower_bound(images.begin(), images.end(), begin);
       image != images.end() && *image <= end; ++image) {
    longest = std::max(longest, *image - last);
    last = *image;
  }
  return longest;
}

std::string seconds(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.3f s", value);
  return text;
}

void Checks::check(const std::string& name, bool passed, const std::string& seen) {
  ++count_;
  failed_ += passed ? 0 : 1;
  std::printf("CHECK %s|%s|%s\n", passed ? "passed" : "failed", name.c_str(), seen.c_str());
  std::fflush(stdout);
}

void Checks::recovers(const std::string& name,
                      const RunningDriver& driver,
                      const std::function<void()>& disturb,
                      int times) {
  double slowest = 0.0;
  double pause = 0.0;
  for (int i = 0; i < times; ++i) {
    sleepFor(kShift * i);
    const double since = now();
    disturb();
    double time = -1.0;
    waitFor([&] { return (time = recoveryTime(driver.images(), since)) >= 0.0; }, kPatience);
    if (time < 0.0) {
      const std::string reason = driver.link().error;
      check(name, false,
            "no stream within " + seconds(kPatience) + " the " + std::to_string(i + 1) +
                ". time; " + (reason.empty() ? "the driver gives no reason" : reason));
      return;
    }
    slowest = std::max(slowest, time);
    pause = std::max(pause, longestPause(driver.images(), since, since + time + kWindow));
  }
  check(name, slowest <= kLongestRecovery,
        (times > 1 ? std::to_string(times) + " times, back after at most " : "back after ") +
            seconds(slowest) + ", longest pause " + seconds(pause));
}

}  // namespace wiimote_tracker::real_kernel
