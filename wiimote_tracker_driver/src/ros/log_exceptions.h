#ifndef WIIMOTE_TRACKER_DRIVER_ROS_LOG_EXCEPTIONS_H
#define WIIMOTE_TRACKER_DRIVER_ROS_LOG_EXCEPTIONS_H

#include "clock_reading.h"

#include <ros/console.h>

#include <atomic>
#include <exception>
#include <string>

namespace wiimote_tracker::driver {

/// Logs an exception, at most every 10 s. (ROS_ERROR_THROTTLE would throw without a ros::Time.)
inline void logInternalError(const std::string& camera, const char* what) {
  constexpr double kRepeatAfter = 10.0;  // [s]
  static std::atomic<double> logged_at{-kRepeatAfter};
  const double now = steadyNow();
  double before = logged_at;
  if (now - before >= kRepeatAfter && logged_at.compare_exchange_strong(before, now))
    ROS_ERROR("%s: internal error (%s): please report it", camera.c_str(), what);
}

/// Calls `callback` and logs what it throws: an exception that left a callback or a thread would
/// end the node, or the nodelet manager with all its cameras.
template <typename Callback>
void logExceptions(const std::string& camera, Callback callback) {
  try {
    callback();
  } catch (const std::exception& e) {
    logInternalError(camera, e.what());
  } catch (...) {
    logInternalError(camera, "of unknown type");
  }
}

}  // namespace wiimote_tracker::driver

#endif  // WIIMOTE_TRACKER_DRIVER_ROS_LOG_EXCEPTIONS_H
