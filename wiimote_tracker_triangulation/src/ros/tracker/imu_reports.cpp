#include "imu_reports.h"

#include <cmath>

namespace wiimote_tracker {

namespace {

constexpr double kPatience = 1.0;  // [s]
constexpr double kPause = 10.0;    // [s]

/// Times may go back.
bool isWithin(double seconds, const std::optional<double>& last, double time) {
  return last && std::abs(time - *last) < seconds;
}

}  // namespace

std::optional<std::string> ImuReports::add(const body::Constellation& constellation,
                                           const body::BodyEstimate& body,
                                           double time) {
  const bool is_hidden = !body.tracked && !body.inertial && !body.lost;
  if (!constellation.imu || is_hidden)
    return std::nullopt;
  Body& known = bodies_[constellation.name];
  if (body.inertial || body.lost) {
    known.unused_since.reset();
    return std::nullopt;
  }
  if (!known.unused_since)
    known.unused_since = time;
  if (isWithin(kPatience, known.unused_since, time) || isWithin(kPause, known.reported, time))
    return std::nullopt;
  known.reported = time;
  return "the IMU of " + constellation.name + " (" + constellation.imu->topic +
         ") is not used, since its samples do not fit the images: check that they come 25 times a "
         "second or more, in m/s^2 with gravity and rad/s, and its clock_offset and mount";
}

}  // namespace wiimote_tracker
