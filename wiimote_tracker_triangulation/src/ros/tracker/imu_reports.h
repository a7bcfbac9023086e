#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_TRACKER_IMU_REPORTS_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_TRACKER_IMU_REPORTS_H

#include "body/body_estimate.h"
#include "body/constellation.h"
#include "wiimote_tracker_triangulation/geometry/rig.h"

#include <map>
#include <optional>
#include <string>

namespace wiimote_tracker {

/// Says why IMUs of bodies are not used: because the world's z axis does not point up, once; or
/// because the samples of a tracked body are missing or do not fit the images, after a second, then
/// every ten. Each function returns one sentence, if one is due.
class ImuReports {
 public:
  void setRig(const geometry::Rig& rig);

  /// Whether the world's z axis points up by the cameras' accelerometers, or none tells.
  bool isLevel() const { return tilt_.empty(); }

  /// When a sample comes and the world is not level.
  std::optional<std::string> addSample();

  /// @param body at a time [s].
  std::optional<std::string> add(const body::Constellation& constellation,
                                 const body::BodyEstimate& body,
                                 double time);

 private:
  struct Body {
    std::optional<double> unused_since;  // [s]
    std::optional<double> reported;      // [s]
  };
  std::string tilt_;  // sentence about the world's z axis; empty: it is level
  bool tilt_reported_ = false;
  std::map<std::string, Body> bodies_;
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_TRACKER_IMU_REPORTS_H
