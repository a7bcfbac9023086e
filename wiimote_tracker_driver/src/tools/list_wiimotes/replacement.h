#ifndef WIIMOTE_TRACKER_DRIVER_LIST_WIIMOTES_REPLACEMENT_H
#define WIIMOTE_TRACKER_DRIVER_LIST_WIIMOTES_REPLACEMENT_H

#include <string>

namespace wiimote_tracker::list_wiimotes {

/// A camera whose remote is replaced by another one.
struct Replacement {
  std::string camera;              ///< Its name, which it keeps.
  std::string address;             ///< Bluetooth address of the new remote.
  std::string cameras_file;        ///< Path of the cameras.yaml.
  std::string camera_info_folder;  ///< Where <camera>.yaml is, the calibration of its lens.
  std::string date;                ///< Goes into the name of the calibration that is set aside.
};

/// Writes the new address under the camera's name, and sets its calibration, which is of the old
/// remote's lens, aside as <camera>.yaml.replaced-<date>. A rig.yaml keeps the old address: that is
/// how the programs that read it know that the camera is to be calibrated again.
/// @returns what was done, one sentence a line. @throws CameraListError when it cannot be done;
/// then nothing has changed.
std::string replaceRemote(const Replacement& replacement);

}  // namespace wiimote_tracker::list_wiimotes

#endif  // WIIMOTE_TRACKER_DRIVER_LIST_WIIMOTES_REPLACEMENT_H
