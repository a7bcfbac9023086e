#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_TRACKER_IMU_REPORTS_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_TRACKER_IMU_REPORTS_H

#include "wiimote_tracker_triangulation/body/body_estimate.h"
#include "wiimote_tracker_triangulation/body/constellation.h"

#include <map>
#include <optional>
#include <string>

namespace wiimote_tracker {

/// Says that the IMU of a tracked body is not used, since its samples are missing or do not fit the
/// images: after a second, then every ten.
class ImuReports {
 public:
  /// @param body at a time [s]. @returns one sentence, if one is due.
  std::optional<std::string> add(const body::Constellation& constellation,
                                 const body::BodyEstimate& body,
                                 double time);

 private:
  struct Body {
    std::optional<double> unused_since;  // [s]
    std::optional<double> reported;      // [s]
  };
  std::map<std::string, Body> bodies_;
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_TRACKER_IMU_REPORTS_H
