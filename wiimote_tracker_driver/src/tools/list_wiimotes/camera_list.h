#ifndef WIIMOTE_TRACKER_DRIVER_LIST_WIIMOTES_CAMERA_LIST_H
#define WIIMOTE_TRACKER_DRIVER_LIST_WIIMOTES_CAMERA_LIST_H

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace wiimote_tracker::list_wiimotes {

/// A list of cameras that cannot be used; what() says why and what to do.
struct CameraListError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The remotes of a rig by name: the text of a cameras.yaml, which is "cameras:" and below it for
/// each camera one line 'name: "device"', or 'name:' with 'identity: "device"' among the lines
/// below it. Above it "discover: true" may stand, which asks for drivers of other remotes, too. All
/// else stays as it is: order, comments, other lines below a name.
class CameraList {
 public:
  struct Entry {
    std::string name;
    std::string device;
  };

  /// An empty list, with a comment that says what it is.
  CameraList();

  /// @throws CameraListError for text of another form than above.
  explicit CameraList(const std::string& text);

  /// In the order of the file.
  std::vector<Entry> entries() const;

  /// The camera with this device (addresses in any case); empty when there is none.
  std::string nameOf(const std::string& device) const;

  /// Gives a new device to a camera. @throws CameraListError when there is no such camera.
  void replace(const std::string& name, const std::string& device);

  /// Appends a camera under the first free name of wiimote_1, wiimote_2, ... @returns the name.
  std::string add(const std::string& device);

  std::string text() const;

 private:
  /// A line that names a device, or another one (then entry.name is empty).
  struct Line {
    std::string text;
    Entry entry;
    std::string key;         ///< What stands before the device, with its blanks.
    std::string comment;     ///< What stands behind it, with its blanks.
    bool in_camera = false;  ///< This line is part of a camera.
  };

  Line* find(const std::string& name);
  static void setDevice(Line& line, const std::string& device);

  std::vector<Line> lines_;
  std::string indent_ = "  ";  ///< Before the names.
};

/// @throws CameraListError when the file cannot be read or used.
CameraList readCameraList(const std::string& path);

/// Writes the file anew and then renames it, so that it is never half there; the one before stays
/// as <path>.bak. @throws CameraListError when that is not possible.
void writeCameraList(const CameraList& list, const std::string& path);

}  // namespace wiimote_tracker::list_wiimotes

#endif  // WIIMOTE_TRACKER_DRIVER_LIST_WIIMOTES_CAMERA_LIST_H
