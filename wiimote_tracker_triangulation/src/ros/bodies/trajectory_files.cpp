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
    const auto& q = body.pose.pose.orientation;
    file.add(static_cast<std::int64_t>(bodies.header.stamp.toNSec()),
             vectorOf(body.pose.pose.position), Eigen::Quaterniond(q.w, q.x, q.y, q.z));
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
