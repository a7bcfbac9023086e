#include "source.h"

#include <wiimote_tracker_msgs/text.h>
#include <wiimote_tracker_triangulation/geometry/rig_file.h>

#include <algorithm>
#include <cstddef>
#include <map>

namespace wiimote_tracker::self_calibrate {

Recording subsetOf(const Recording& recording, const std::vector<std::string>& names) {
  std::vector<std::size_t> kept;
  std::vector<std::string> known;
  for (std::size_t i = 0; i < recording.cameras.size(); ++i) {
    known.push_back(recording.cameras[i].name);
    if (std::find(names.begin(), names.end(), recording.cameras[i].name) != names.end())
      kept.push_back(i);
  }
  if (kept.size() != names.size())
    throw ImportError("the camera subset must name cameras of the recording once each; it has: " +
                      joined(known));
  Recording subset;
  for (const std::size_t i : kept)
    subset.cameras.push_back(recording.cameras[i]);
  for (const Pixels& all : recording.frames) {
    Pixels pixels;
    for (const std::size_t i : kept)
      pixels.push_back(all[i]);
    subset.frames.push_back(pixels);
  }
  subset.points = recording.points;
  return subset;
}

void takeIntrinsics(const std::string& path, Recording* recording) {
  std::map<std::string, geometry::Intrinsics> by_name;
  if (import::fileExists(path + "/Res.dat")) {
    for (const RecordedCamera& camera : import::readRecording(path).cameras)
      by_name[camera.name] = camera.intrinsics;
  } else {
    for (const geometry::RigCamera& camera : geometry::readRigFile(path).cameras)
      by_name[camera.camera.name] = camera.camera.intrinsics;
  }
  for (RecordedCamera& camera : recording->cameras) {
    const auto found = by_name.find(camera.name);
    if (found == by_name.end())
      throw ImportError(path + " has no intrinsics of " + camera.name +
                        ": add them, or leave the camera out with --camera-subset");
    if (found->second.width != camera.intrinsics.width ||
        found->second.height != camera.intrinsics.height)
      throw ImportError(path + " has intrinsics of " + camera.name +
                        " for another image size than the recording");
    camera.intrinsics = found->second;
    camera.has_intrinsics = true;
  }
}

}  // namespace wiimote_tracker::self_calibrate
