#ifndef WIIMOTE_TRACKER_DRIVER_LIST_WIIMOTES_ARGUMENTS_H
#define WIIMOTE_TRACKER_DRIVER_LIST_WIIMOTES_ARGUMENTS_H

#include <wiimote_tracker_msgs/argument_parser.h>

#include <string>
#include <vector>

namespace wiimote_tracker::list_wiimotes {

/// Arguments of the program.
struct Arguments {
  bool identify = false;
  std::string write;                 ///< A cameras.yaml, may be new; or empty.
  std::string cameras;               ///< A cameras.yaml, or empty.
  std::string device;                ///< Address or path of the only remote to list, or empty.
  std::vector<std::string> sockets;  ///< Of virtual remotes.
  std::vector<std::string> replace;  ///< A camera's name and its new address; empty: list.
  std::string camera_info;           ///< A folder; empty: the default of camera_info_manager.
};

/// The parser that sets them.
ArgumentParser parserOf(Arguments* arguments);

/// What the parser cannot know; `device` becomes what the driver calls it. @throws BadArguments.
void check(Arguments* arguments);

}  // namespace wiimote_tracker::list_wiimotes

#endif  // WIIMOTE_TRACKER_DRIVER_LIST_WIIMOTES_ARGUMENTS_H
