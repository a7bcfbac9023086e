#pragma once

#include <chrono>
#include <thread>

namespace wiimote_tracker {

/// The steady clock [s].
inline double steadyNow() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Waits until the condition holds; false after 20 s.
template <typename Condition>
bool eventually(Condition condition) {
  for (const double deadline = steadyNow() + 20.0; !condition();) {
    if (steadyNow() > deadline)
      return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}

}  // namespace wiimote_tracker
