#pragma once

#include <ros/console.h>

#include <atomic>
#include <chrono>
#include <exception>
#include <string>

namespace wiimote_tracker {

/// Calls `work` and logs what it throws, at most once every 10 s: an exception that left a callback
/// or a thread would end the process, with all nodelets in it.
/// @param name of the camera or the callback, for the log.
template <typename Work>
void logExceptions(const std::string& name, const Work& work) {
  const auto log = [&name](const char* what) {
    // ROS_ERROR_THROTTLE would throw before ros::Time is initialised.
    using Clock = std::chrono::steady_clock;
    constexpr Clock::duration kRepeatAfter = std::chrono::seconds(10);
    static std::atomic<Clock::duration> logged_at{-kRepeatAfter};
    const Clock::duration now = Clock::now().time_since_epoch();
    Clock::duration before = logged_at;
    if (now - before >= kRepeatAfter && logged_at.compare_exchange_strong(before, now))
      ROS_ERROR("%s: internal error (%s): please report it", name.c_str(), what);
  };
  try {
    work();
  } catch (const std::exception& e) {
    log(e.what());
  } catch (...) {
    log("of unknown type");
  }
}

}  // namespace wiimote_tracker
