#pragma once

#include "running_driver.h"

#include <cstddef>
#include <deque>
#include <functional>
#include <string>

namespace wiimote_tracker::real_kernel {

/// The checks of one scenario. Each prints a line: "CHECK passed|name|what was seen", or why it was
/// skipped.
class Checks {
 public:
  void check(const std::string& name, bool passed, const std::string& seen = "");

  void skip(const std::string& name, const std::string& reason);

  /// Disturbs the remote `times` times and checks that the driver's images are back within 1 s of
  /// recoveryTime(). The moments differ relative to the remote's samples.
  void recovers(const std::string& name,
                const RunningDriver& driver,
                const std::function<void()>& disturb,
                int times = 1);

  /// Disturbs the remote and checks that the driver detects it within this time [s], reports it
  /// under this name, corrects it once, and keeps streaming.
  void restores(const std::string& name,
                const RunningDriver& driver,
                const std::function<void()>& disturb,
                const std::string& found,
                double within);

  /// Checks that images are back within 1 s of a disturbance that began at `since` [s].
  void recoversFrom(const std::string& name, const RunningDriver& driver, double since);

  /// Checks that the driver gets images for this time [s], at its recoveryRate() or more and
  /// without a pause of 0.1 s. `kind` begins the checks' names.
  void streams(const std::string& kind, const RunningDriver& driver, double duration);

  /// Checks that the drivers of remotes 1, 2, ... get images for 5 s at 90 Hz or more.
  void streamForLong(const std::deque<RunningDriver>& drivers);

  /// All images that the drivers have published.
  ImageTotals images;

  bool passed() const { return count_ > 0 && failed_ == 0; }

 private:
  int count_ = 0;
  int failed_ = 0;
};

/// "0.123 s"
std::string seconds(double value);

/// "123 things"
std::string count(std::size_t number, const std::string& things);

}  // namespace wiimote_tracker::real_kernel
