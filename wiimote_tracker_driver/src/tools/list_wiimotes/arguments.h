#ifndef WIIMOTE_TRACKER_DRIVER_LIST_WIIMOTES_ARGUMENTS_H
#define WIIMOTE_TRACKER_DRIVER_LIST_WIIMOTES_ARGUMENTS_H

#include <stdexcept>
#include <string>
#include <vector>

namespace wiimote_tracker::list_wiimotes {

struct BadArguments : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// What is to be done.
struct Arguments {
  bool help = false;
  bool identify = false;
  std::string write;                 ///< A cameras.yaml, may be new; or empty.
  std::string cameras;               ///< A cameras.yaml, or empty.
  std::string device;                ///< Address or path of the only remote to list, or empty.
  std::vector<std::string> sockets;  ///< Of virtual remotes.
  std::string replaced_camera;       ///< Its name; empty: list.
  std::string new_address;
  std::string camera_info;  ///< A folder; empty: where camera_info_manager has it.
};

/// For people.
extern const char* const kUsage;

/// @throws BadArguments for what makes no sense.
Arguments parseArguments(int argc, char** argv);

}  // namespace wiimote_tracker::list_wiimotes

#endif  // WIIMOTE_TRACKER_DRIVER_LIST_WIIMOTES_ARGUMENTS_H
