#include "link_log.h"

#include <ros/console.h>

namespace wiimote_tracker::driver {
namespace {

constexpr double kRepeatErrorAfter = 30.0;  // [s]

}  // namespace

void LinkLog::report(const wiimote::Link& link, double now) {
  const bool streams =
      link.state == wiimote::Link::State::kStreaming && state_ != wiimote::Link::State::kStreaming;
  state_ = link.state;
  if (!link.error.empty()) {
    reportError(link.error, now);
    return;
  }
  error_.clear();
  if (streams)
    reportStream(link);
}

void LinkLog::notice(const std::string& text) {
  if (text != notice_ && !text.empty())
    ROS_WARN("%s: %s", camera_.c_str(), text.c_str());
  notice_ = text;
}

void LinkLog::reportError(const std::string& error, double now) {
  if (error == error_ && now - error_logged_at_ <= kRepeatErrorAfter)
    return;
  error_ = error;
  error_logged_at_ = now;
  ROS_WARN("%s: %s%s", camera_.c_str(), error.c_str(), retries_ ? " (trying again)" : "");
}

void LinkLog::reportStream(const wiimote::Link& link) const {
  const char* camera = camera_.c_str();
  ROS_INFO("%s: images come from %s (%s)", camera, link.description.c_str(), link.identity.c_str());
  if (!link.accelerometer_calibrated)
    ROS_WARN("%s: %s", camera, kDamagedAccelerometer);
  if (link.kernel_driver == "wiimote")
    ROS_WARN("%s: %s", camera, kKernelDriverShares);
}

}  // namespace wiimote_tracker::driver
