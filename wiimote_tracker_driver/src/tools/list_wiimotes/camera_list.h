#pragma once

#include <wiimote_tracker_msgs/error.h>

#include <cstddef>
#include <string>
#include <vector>

namespace wiimote_tracker::list_wiimotes {

/// A list of cameras that cannot be used; what() says why and what to do.
struct CameraListError : Error {
  using Error::Error;
};

/// The remotes of a rig by name: the text of a cameras.yaml. Below "cameras:" each camera has a
/// line 'name: "device"', or 'name:' with 'identity: "device"' among the lines below it. "discover:
/// true" may stand above. Changes keep the order, the comments and all other lines.
class CameraList {
 public:
  struct Camera {
    std::string name;
    std::string device;
    std::size_t line = 0;             ///< Of the device, from 0.
    std::size_t begin = 0, size = 0;  ///< Of the device in its line, with its quotes.
  };

  /// An empty list with a comment that explains the file.
  CameraList();

  /// @throws CameraListError for text of another form than above.
  explicit CameraList(const std::string& text);

  /// In the order of the file.
  const std::vector<Camera>& cameras() const { return cameras_; }

  /// The camera with this device (addresses in any case); empty when there is none.
  std::string nameOf(const std::string& device) const;

  /// Gives a new device to a camera. @throws CameraListError when there is no such camera.
  void replace(const std::string& name, const std::string& device);

  /// Appends a camera under the first free name of wiimote_1, wiimote_2, ... @returns the name.
  std::string add(const std::string& device);

  std::string text() const;

 private:
  const Camera* find(const std::string& name) const;

  std::vector<std::string> lines_;
  std::vector<Camera> cameras_;
  std::string indent_ = "  ";  ///< Before the names.
};

/// What keeps drivers from using the list, one sentence each that says what to do: devices that are
/// none, or that two cameras have.
std::vector<std::string> problems(const CameraList& list);

/// @throws CameraListError when the file cannot be read or used.
CameraList readCameraList(const std::string& path);

/// Refuses the name of a pipe, device or socket: reading a pipe may never end, and the file would
/// take its place. @throws CameraListError.
void requireFile(const std::string& path);

/// Replaces the file atomically, and keeps the old one as <path>.bak.
/// @throws CameraListError if that is not possible.
void writeCameraList(const CameraList& list, const std::string& path);

}  // namespace wiimote_tracker::list_wiimotes
