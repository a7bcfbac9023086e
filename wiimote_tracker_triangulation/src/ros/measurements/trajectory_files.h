#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_MEASUREMENTS_TRAJECTORY_FILES_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_MEASUREMENTS_TRAJECTORY_FILES_H

#include "ros/measurements/part_file.h"

#include <wiimote_tracker_msgs/TrackedBodyArray.h>

#include <map>
#include <string>

namespace wiimote_tracker::measurements {

/// The poses of each tracked body in a file <folder>/<body>.tum, as the TUM RGB-D benchmark defines
/// it and evo reads it: one line `time x y z qx qy qz qw` a pose, [s since 1970] and [m]. All throw
/// Error.
class TrajectoryFiles {
 public:
  /// @param folder empty: nothing is written.
  explicit TrajectoryFiles(const std::string& folder) : folder_(folder) {}

  static std::string pathOf(const std::string& folder, const std::string& body);

  void add(const wiimote_tracker_msgs::TrackedBodyArray& bodies);
  void flush();
  void finish();
  void removeParts() const;

 private:
  std::string folder_;
  std::map<std::string, OutputFile> files_;  // by body
};

}  // namespace wiimote_tracker::measurements

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_MEASUREMENTS_TRAJECTORY_FILES_H
