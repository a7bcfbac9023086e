#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_TRACKER_IMU_REPORTS_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_TRACKER_IMU_REPORTS_H

#include "wiimote_tracker_triangulation/body/constellation.h"

#include <map>
#include <optional>
#include <string>

namespace wiimote_tracker {

/// Says that the IMU of a tracked body is not used: after a second, then every ten.
class ImuReports {
 public:
  /// To be called for each image in which the body is tracked.
  /// @param is_unused its samples are missing, or do not fit the images. @param time of these [s].
  /// @returns one sentence, if one is due.
  std::optional<std::string> add(const body::Constellation& body, bool is_unused, double time);

 private:
  std::map<std::string, double> due_;  // [s]; of bodies whose IMU is not used
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_TRACKER_IMU_REPORTS_H
