#include "ros/measurements/trajectory_files.h"

#include "ros/measurements/writer.h"

#include <unistd.h>

#include <locale>
#include <sstream>

namespace wiimote_tracker::measurements {

using wiimote_tracker_msgs::TrackedBody;

std::string TrajectoryFiles::pathOf(const std::string& folder, const std::string& body) {
  return folder + "/" + body + ".tum";
}

void TrajectoryFiles::add(const wiimote_tracker_msgs::TrackedBodyArray& bodies) {
  if (folder_.empty())
    return;
  for (const TrackedBody& body : bodies.bodies) {
    if (body.state != TrackedBody::TRACKED)
      continue;
    std::ostringstream line;
    line.imbue(std::locale::classic());
    line.precision(9);
    line << secondsOf(bodies.header.stamp);
    const geometry_msgs::Point& p = body.pose.pose.position;
    const geometry_msgs::Quaternion& q = body.pose.pose.orientation;
    for (const double value : {p.x, p.y, p.z, q.x, q.y, q.z, q.w})
      line << ' ' << value;
    line << '\n';
    files_.try_emplace(body.name, pathOf(folder_, body.name)).first->second.write(line.str());
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

void TrajectoryFiles::removeParts() const {
  for (const auto& [body, file] : files_)
    ::unlink(partOf(pathOf(folder_, body)).c_str());
}

}  // namespace wiimote_tracker::measurements
