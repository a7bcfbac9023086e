#pragma once

#include <chrono>
#include <thread>

namespace wiimote_tracker::real_kernel {

/// The guest's clock [s]; never goes back.
inline double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

inline void sleepFor(double seconds) {
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
}

/// Waits until `condition` holds, at most `timeout` [s]. @returns whether it holds.
template <typename Condition>
bool waitFor(Condition condition, double timeout) {
  for (const double end = now() + timeout; now() < end; sleepFor(0.002)) {
    if (condition())
      return true;
  }
  return condition();
}

}  // namespace wiimote_tracker::real_kernel
