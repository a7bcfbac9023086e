#pragma once

#include <string>

namespace wiimote_tracker::list_wiimotes {

/// A camera whose remote is replaced by another one.
struct Replacement {
  std::string camera;              ///< Its name, which it keeps.
  std::string address;             ///< Bluetooth address of the new remote.
  std::string cameras_file;        ///< Path of the cameras.yaml.
  std::string camera_info_folder;  ///< Where <camera>.yaml is, the calibration of its lens.
  std::string date;                ///< For the new name of the calibration.
};

/// Writes the new address under the camera's name, and renames its calibration, which belongs to
/// the old remote's lens, to <camera>.yaml.replaced-<date>. A rig.yaml keeps the old address, by
/// which programs notice that the camera must be calibrated again.
/// @returns what was done, one sentence per line. @throws CameraListError if it cannot be done;
/// then nothing has changed.
std::string replaceRemote(const Replacement& replacement);

}  // namespace wiimote_tracker::list_wiimotes
