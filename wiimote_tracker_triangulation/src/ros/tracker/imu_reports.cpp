#include "imu_reports.h"

#include <wiimote_tracker_msgs/text.h>

#include <cmath>
#include <utility>

namespace wiimote_tracker {
namespace {

constexpr double kMostTilt = 10.0;  // [degrees]
constexpr double kPatience = 1.0;   // [s]
constexpr double kPause = 10.0;     // [s]

/// The angle between the world's z axis and up, by the cameras' accelerometers [degrees]; 0: not
/// known.
double tiltOf(const geometry::Rig& rig) {
  Eigen::Vector3d up = Eigen::Vector3d::Zero();
  for (const geometry::RigCamera& camera : rig.cameras) {
    if (camera.gravity)
      up += (camera.camera.world_from_camera.linear() * *camera.gravity).normalized();
  }
  return std::atan2(up.head<2>().norm(), up.z()) * 180.0 / M_PI;
}

/// Times may go back.
bool isWithin(double seconds, const std::optional<double>& last, double time) {
  return last && std::abs(time - *last) < seconds;
}

}  // namespace

void ImuReports::setRig(const geometry::Rig& rig) {
  const double tilt = tiltOf(rig);
  tilt_.clear();
  if (tilt > kMostTilt)
    tilt_ = format(
        "the world's z axis is %.0f degrees from up by the cameras' accelerometers, so the IMUs of "
        "bodies are not used: calibrate with a level square, its corners taken counter-clockwise",
        tilt);
  tilt_reported_ = tilt_reported_ && !isLevel();
}

std::optional<std::string> ImuReports::addSample() {
  return isLevel() || std::exchange(tilt_reported_, true) ? std::nullopt : std::optional(tilt_);
}

std::optional<std::string> ImuReports::add(const body::Constellation& constellation,
                                           const body::BodyEstimate& body,
                                           double time) {
  const bool is_hidden = !body.tracked && !body.inertial && !body.lost;
  if (!constellation.imu || is_hidden || !isLevel())
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
