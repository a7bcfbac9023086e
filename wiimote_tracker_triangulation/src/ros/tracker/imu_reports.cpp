#include "imu_reports.h"

namespace wiimote_tracker {

namespace {

constexpr double kPatience = 1.0;  // [s]
constexpr double kPause = 10.0;    // [s]

}  // namespace

std::optional<std::string> ImuReports::add(const body::Constellation& body,
                                           bool is_unused,
                                           double time) {
  if (!is_unused) {
    due_.erase(body.name);
    return std::nullopt;
  }
  double& due = due_.emplace(body.name, time + kPatience).first->second;
  if (time < due && time >= due - kPause)  // else time jumped back
    return std::nullopt;
  due = time + kPause;
  return "the IMU of " + body.name + " (" + body.imu->topic +
         ") is not used, since its samples do not fit the images: check that they come 25 times a "
         "second or more, in m/s^2 with gravity and rad/s, and its clock_offset and mount";
}

}  // namespace wiimote_tracker
