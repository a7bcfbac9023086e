#ifndef WIIMOTE_TRACKER_DRIVER_LIST_WIIMOTES_ARGUMENTS_H
#define WIIMOTE_TRACKER_DRIVER_LIST_WIIMOTES_ARGUMENTS_H

#include <string>
#include <vector>

namespace wiimote_tracker::list_wiimotes {

/// Arguments of the program.
struct Arguments {
  std::string help;  ///< Text to print instead of anything else; or empty.
  bool identify = false;
  std::string write;                 ///< A cameras.yaml, may be new; or empty.
  std::string cameras;               ///< A cameras.yaml, or empty.
  std::string device;                ///< Address or path of the only remote to list, or empty.
  std::vector<std::string> sockets;  ///< Of virtual remotes.
  std::string replaced_camera;       ///< Its name; empty: list.
  std::string new_address;
  std::string camera_info;  ///< A folder; empty: the default of camera_info_manager.
};

/// @throws tools::BadArguments.
Arguments parseArguments(int argc, char** argv);

}  // namespace wiimote_tracker::list_wiimotes

#endif  // WIIMOTE_TRACKER_DRIVER_LIST_WIIMOTES_ARGUMENTS_H
