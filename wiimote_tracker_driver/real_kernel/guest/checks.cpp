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
                      const std::function<void()>& disturb) {
  const double since = now();
  disturb();
  double time = -1.0;
  waitFor([&] { return (time = recoveryTime(driver.images(), since)) >= 0.0; }, kPatience);
  const wiimote::Link link = driver.link();
  check(name, time >= 0.0 && time <= kLongestRecovery,
        time >= 0.0 ? "back after " + seconds(time) + ", longest pause " +
                          seconds(longestPause(driver.images(), since, since + time + kWindow))
                    : "no images within " + seconds(kPatience) + "; " +
                          (link.error.empty() ? "the driver gives no reason" : link.error));
}

}  // namespace wiimote_tracker::real_kernel
