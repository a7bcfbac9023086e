#include "camera_fault.h"

#include <wiimote_tracker_msgs/text.h>

#include <cmath>

namespace wiimote_tracker {

std::string describe(const tracking::CameraFault& fault, const std::string& camera) {
  const double seconds = std::fabs(fault.clock_ahead);
  const char* name = camera.c_str();
  switch (fault.kind) {
    case tracking::CameraFault::Kind::kMisfit:
      return format(
          "the spots of %s are not where other cameras see LEDs, and its images are "
          "ignored: if it was moved or exchanged, put it back or calibrate again; mask "
          "lamps and reflections",
          name);
    case tracking::CameraFault::Kind::kInaccurate:
      return format(
          "the calibration of %s is too inaccurate where the LEDs are now, and its images are "
          "ignored: calibrate again, with a waved LED",
          name);
    case tracking::CameraFault::Kind::kCorrectedClock:
      return format(
          "the times of the images of %s are %.3g s too %s, by the motion of the LEDs, and "
          "are corrected: run chrony on all computers, or calibrate again",
          name, seconds, fault.clock_ahead > 0.0 ? "late" : "early");
    case tracking::CameraFault::Kind::kLate:
      return format(
          "the images of %s are stamped %.3g s before images of other cameras that come with "
          "them, and are ignored: correct ~latency of its driver, or raise tracks/history",
          name, seconds);
    case tracking::CameraFault::Kind::kWrongClock:
      break;
  }
  if (std::isnan(seconds))
    return format(
        "the clocks of the cameras' computers disagree and no group of them is the "
        "largest, so images of %s are ignored: run chrony on all computers",
        name);
  return format(
      "the clock of the computer of %s is %.3g s %s most cameras' clocks, and its images "
      "are ignored: run chrony on all computers",
      name, seconds, fault.clock_ahead > 0.0 ? "ahead of" : "(or its network) behind");
}

}  // namespace wiimote_tracker
