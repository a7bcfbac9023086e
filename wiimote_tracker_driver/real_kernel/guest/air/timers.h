#pragma once

#include "clock.h"

#include <algorithm>
#include <functional>
#include <map>
#include <utility>

namespace wiimote_tracker::real_kernel {

/// Functions to be called later, in order of time.
class Timers {
 public:
  void at(double time, std::function<void()> function) {
    functions_.emplace(time, std::move(function));
  }
  void after(double seconds, std::function<void()> function) {
    at(now() + seconds, std::move(function));
  }

  /// Calls all that are due. @returns the time until the next one, at most `longest` [s].
  double run(double longest) {
    while (!functions_.empty()) {
      const auto first = functions_.begin();
      const double left = first->first - now();
      if (left > 0.0)
        return std::min(left, longest);
      const std::function<void()> function = std::move(first->second);
      functions_.erase(first);
      function();
    }
    return longest;
  }

 private:
  std::multimap<double, std::function<void()>> functions_;
};

}  // namespace wiimote_tracker::real_kernel
