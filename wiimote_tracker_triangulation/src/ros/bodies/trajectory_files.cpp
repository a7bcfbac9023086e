#include "trajectory_files.h"

#include "wiimote_tracker_triangulation/ros/message_fields.h"

#include <cstdint>

namespace wiimote_tracker {

using wiimote_tracker_msgs::TrackedBody;

void TrajectoryFiles::add(const wiimote_tracker_msgs::TrackedBodyArray& bodies) {
  if (folder_.empty())
    return;
  for (const TrackedBody& body : bodies.bodies) {
    if (body.state != TrackedBody::TRACKED)
      continue;
    measurements::TumWriter& file =
        files_.try_emplace(body.name, folder_ + "/" + body.name + ".tum").first->second;
    file.add(static_cast<std::int64_t>(bodies.header.stamp.toNSec()),
             vectorOf(body.pose.pose.position), rotationOf(body.pose.pose.orientation));
  }
}

void TrajectoryFiles::flush() {
  for (auto& [body, file] : files_)
    file.flush();
}

void TrajectoryFiles::finish() {
  for (auto& [body, file] : files_)
    file.finish();
}

}  // namespace wiimote_tracker
