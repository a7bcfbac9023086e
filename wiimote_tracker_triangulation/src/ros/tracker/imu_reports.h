#pragma once

#include "body/body_estimate.h"
#include "body/constellation.h"
#include "wiimote_tracker_triangulation/geometry/rig.h"

#include <wiimote_tracker_msgs/text.h>

#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>

namespace wiimote_tracker {

/// Says why IMUs of bodies are not used: because the world's z axis does not point up, once; or
/// because the samples of a tracked body are missing or do not fit the images, after a second, then
/// every ten. Each function returns one sentence, if one is due.
class ImuReports {
 public:
  void setRig(const geometry::Rig& rig) {
    const double tilt = tiltOf(rig);
    tilt_.clear();
    if (tilt > kMostTilt)
      tilt_ = format(
          "the world's z axis is %.0f degrees from up by the cameras' accelerometers, so the "
          "IMUs of bodies are not used: calibrate with a level square, its corners taken "
          "counter-clockwise",
          tilt);
    tilt_reported_ = tilt_reported_ && !isLevel();
  }

  /// Whether the world's z axis points up by the cameras' accelerometers, or none tells.
  bool isLevel() const { return tilt_.empty(); }

  /// When a sample comes and the world is not level.
  std::optional<std::string> addSample() {
    return isLevel() || std::exchange(tilt_reported_, true) ? std::nullopt : std::optional(tilt_);
  }

  /// @param body at a time [s].
  std::optional<std::string> add(const body::Constellation& constellation,
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
           ") is not used, since its samples are missing or do not fit the images: check that "
           "they come 25 times a second or more, in m/s^2 with gravity and rad/s, and its "
           "clock_offset and mount";
  }

 private:
  static constexpr double kMostTilt = 10.0;  // [degrees]
  static constexpr double kPatience = 1.0;   // [s]
  static constexpr double kPause = 10.0;     // [s]

  struct Body {
    std::optional<double> unused_since;  // [s]
    std::optional<double> reported;      // [s]
  };

  /// The angle between the world's z axis and up, by the cameras' accelerometers [degrees]; 0: not
  /// known.
  static double tiltOf(const geometry::Rig& rig) {
    Eigen::Vector3d up = Eigen::Vector3d::Zero();
    for (const geometry::RigCamera& camera : rig.cameras) {
      if (camera.gravity)
        up += (camera.camera.world_from_camera.linear() * *camera.gravity).normalized();
    }
    return std::atan2(up.head<2>().norm(), up.z()) * 180.0 / M_PI;
  }

  /// Times may go back.
  static bool isWithin(double seconds, const std::optional<double>& last, double time) {
    return last && std::abs(time - *last) < seconds;
  }

  std::string tilt_;  // sentence about the world's z axis; empty: it is level
  bool tilt_reported_ = false;
  std::map<std::string, Body> bodies_;
};

}  // namespace wiimote_tracker
