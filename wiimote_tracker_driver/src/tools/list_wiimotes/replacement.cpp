#include "replacement.h"

#include "camera_list.h"
#include "transport/transport.h"

#include <filesystem>

namespace wiimote_tracker::list_wiimotes {
namespace {

namespace fs = std::filesystem;

fs::path freeName(const fs::path& wanted) {
  fs::path name = wanted;
  for (int i = 2; fs::exists(name); ++i)
    name = wanted.string() + "-" + std::to_string(i);
  return name;
}

}  // namespace

std::string replaceRemote(const Replacement& replacement) {
  const std::string& camera = replacement.camera;
  const auto address = transport::bluetoothAddress(replacement.address);
  if (!address)
    throw CameraListError("'" + replacement.address +
                          "' is not a Bluetooth address: give that of the new remote, such as "
                          "00:1f:32:12:34:56, as list_wiimotes shows it");
  requireFile(replacement.cameras_file);
  CameraList list = readCameraList(replacement.cameras_file);
  const std::string owner = list.nameOf(*address);
  if (!owner.empty())
    throw CameraListError(*address + " is already camera " + owner +
                          ": give the address of the new remote");
  list.replace(camera, *address);

  const fs::path calibration = fs::path(replacement.camera_info_folder) / (camera + ".yaml");
  std::string done;
  if (fs::exists(calibration)) {
    const fs::path aside = freeName(calibration.string() + ".replaced-" + replacement.date);
    std::error_code error;
    fs::rename(calibration, aside, error);
    if (error)
      throw CameraListError(calibration.string() + " cannot be renamed (" + error.message() +
                            "): it belongs to the old remote's lens, move it away yourself");
    try {
      writeCameraList(list, replacement.cameras_file);
    } catch (const CameraListError&) {
      fs::rename(aside, calibration, error);
      throw;
    }
    done = "The calibration of the old remote's lens is now " + aside.string() + ".\n";
  } else {
    writeCameraList(list, replacement.cameras_file);
  }
  return "Camera " + camera + " is now " + *address + " in " + replacement.cameras_file +
         " (previous list: " + replacement.cameras_file + ".bak).\n" + done +
         "Restart the drivers, then solve this camera again (key r of calibrate), or calibrate "
         "again: until then rig.yaml names the old remote, and the triangulation ignores this "
         "camera.\n";
}

}  // namespace wiimote_tracker::list_wiimotes
