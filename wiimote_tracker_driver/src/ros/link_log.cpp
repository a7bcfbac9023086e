#include "link_log.h"

#include <ros/console.h>

#include <algorithm>

namespace wiimote_tracker::driver {
namespace {

constexpr double kRepeatErrorAfter = 30.0;         // [s]
constexpr double kRepeatRestorationAfter = 600.0;  // [s]
constexpr double kMostAtOnce = 10.0;               // changes that are logged without a pause
constexpr double kPerChange = 600.0;               // until one more change may be logged [s]

}  // namespace

const char* accelerometerProblem(const wiimote::Link& link) {
  if (link.accelerometer_calibrated)
    return nullptr;
  return link.accelerometer_unknown
             ? "the accelerometer calibration of the remote is unknown, a typical one is used: "
               "expect errors of about 0.5 m/s^2"
             : "the accelerometer calibration of the remote is damaged, a typical one is used: "
               "expect errors of about 0.5 m/s^2";
}

LinkLog::LinkLog(const std::string& camera, bool retries)
    : camera_(camera), retries_(retries), allowance_(kMostAtOnce) {}

void LinkLog::report(const wiimote::Link& link, double now) {
  if (!link.error.empty()) {
    announced_epoch_.reset();
    reportError(link.error, now);
    return;
  }
  const bool ends_error = !error_.empty();
  error_.clear();
  reportRestoration(link, now);
  // The same stream goes on after something was put right.
  if (link.state == wiimote::Link::State::kStreaming && announced_epoch_ != link.clock_epoch) {
    announced_epoch_ = link.clock_epoch;
    // An error that was logged gets its end.
    if (ends_error || allows(now))
      reportStream(link);
  }
}

void LinkLog::notice(const std::string& text) {
  if (text != notice_ && !text.empty())
    ROS_WARN("%s: %s", camera_.c_str(), text.c_str());
  notice_ = text;
}

bool LinkLog::allows(double now) {
  allowance_ = std::min(kMostAtOnce, allowance_ + (now - allowance_at_) / kPerChange);
  allowance_at_ = now;
  if (allowance_ < 1.0)
    return false;
  allowance_ -= 1.0;
  return true;
}

void LinkLog::reportError(const std::string& error, double now) {
  if ((error == error_ && now - error_logged_at_ <= kRepeatErrorAfter) || !allows(now))
    return;
  error_ = error;
  error_logged_at_ = now;
  const char* rest = "";
  if (retries_)
    rest = allowance_ < 1.0 ? " (trying again; the log has one message in 10 minutes from now on)"
                            : " (trying again)";
  ROS_WARN("%s: %s%s", camera_.c_str(), error.c_str(), rest);
}

void LinkLog::reportRestoration(const wiimote::Link& link, double now) {
  if (link.restorations == restorations_ || now - restoration_logged_at_ <= kRepeatRestorationAfter)
    return;
  restorations_ = link.restorations;
  if (restorations_ == 1) {  // a busy computer does this, too
    ROS_INFO("%s: put right: %s", camera_.c_str(), link.last_restoration.c_str());
    return;
  }
  restoration_logged_at_ = now;
  ROS_WARN(
      "%s: put right: %s (%llu in all); if this repeats, another program uses the remote: "
      "stop it, or see doc/session.md of wiimote_tracker_driver",
      camera_.c_str(), link.last_restoration.c_str(),
      static_cast<unsigned long long>(restorations_));
}

void LinkLog::reportStream(const wiimote::Link& link) const {
  const char* camera = camera_.c_str();
  ROS_INFO("%s: images come from %s (%s)", camera, link.remote.description.c_str(),
           link.remote.identity.c_str());
  if (const char* problem = accelerometerProblem(link))
    ROS_WARN("%s: %s", camera, problem);
  if (link.remote.kernel_driver == "wiimote")
    ROS_INFO("%s: %s", camera, kKernelDriverShares);
}

}  // namespace wiimote_tracker::driver
