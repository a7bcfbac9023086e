#pragma once

#include <wiimote_tracker_triangulation/geometry/rig.h>

#include <ros/node_handle.h>

#include <cstddef>
#include <map>
#include <mutex>
#include <string>
#include <vector>

namespace wiimote_tracker {

/// The rig files of a node, into which a second tracker with the same ROS_HOME, or a person, may
/// write, too. Knows what was in each file when the node last read or wrote it. For several
/// threads.
class RigFiles {
 public:
  /// As geometry::readRigFile().
  geometry::Rig read(const std::string& path);

  /// Writes rig.yaml (the file before becomes rig.yaml.bak), and beside it, `with_lenses`, one
  /// camera-info YAML per camera, named after the camera. Only rig.yaml is read back by this
  /// package.
  /// @returns warnings: of zones that only the file before has, and one for each camera file that
  /// could not be written, or that would replace a rig or samples.
  /// @throws Error: rig.yaml could not be written, `path` is that of a camera file, or, unless the
  /// call before was the same and refused so, the file would be lost without a word: nobody read or
  /// wrote here what is in it now, or it has a rig of other cameras. Nothing has changed then.
  std::vector<std::string> save(const geometry::Rig& rig,
                                const std::string& path,
                                bool with_lenses = true);

 private:
  std::mutex mutex_;
  std::map<std::string, std::string> known_;  // What is in files, by their whole paths.
  std::string refused_;  // The last call of save(), if it was refused so; empty: it was not.
};

/// Writes a rig into the folder `versions` beside the rig file, named by a time [s] and its id. Of
/// more than `most` such files the oldest are removed.
/// @returns its path. @throws Error: it could not be written.
std::string keepVersion(const geometry::Rig& rig,
                        double time,
                        const std::string& rig_file,
                        std::size_t most = 1000);

/// Which earlier rigs beside the rig file can be loaded, for a refusal to go back.
std::string describeEarlierRigs(const std::string& rig_file);

/// Calls set_camera_info of all these cameras at once, and waits for the answers for at most
/// `timeout` [s], even if a driver never answers. Hold no mutex.
/// @returns warnings: one for each camera that did not accept it, one for all without that service.
std::vector<std::string> sendCameraInfo(const std::vector<geometry::Camera>& cameras,
                                        const ros::NodeHandle& nh,
                                        double timeout);

}  // namespace wiimote_tracker
