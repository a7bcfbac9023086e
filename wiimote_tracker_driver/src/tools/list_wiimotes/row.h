#ifndef WIIMOTE_TRACKER_DRIVER_LIST_WIIMOTES_ROW_H
#define WIIMOTE_TRACKER_DRIVER_LIST_WIIMOTES_ROW_H

#include "camera_list.h"
#include "host.h"
#include "remote_check.h"
#include "transport/transport.h"

#include <string>
#include <vector>

namespace wiimote_tracker::list_wiimotes {

/// A remote in the list.
struct Row {
  transport::DeviceName device;  ///< How to open it.
  std::string text;              ///< Device in a cameras.yaml; empty: impossible.
  std::string address;
  std::string description;
  bool can_be_opened = true;
  std::vector<std::string> hints;
  RemoteCheck check;
  std::string camera;
};

/// The remotes known to the kernel, or only that with the address or path `wanted`.
std::vector<Row> rowsOf(const Host& host, const std::string& wanted);

/// Virtual remotes at these sockets.
std::vector<Row> rowsOf(const std::vector<std::string>& sockets);

/// Tries to talk to the remote, and looks up its name in the list.
void check(const CameraList& list, Row* row);

/// Whether the remote is free or in use by a driver.
bool isFine(const Row& row);

/// To standard output.
void print(int number, const Row& row);

}  // namespace wiimote_tracker::list_wiimotes

#endif  // WIIMOTE_TRACKER_DRIVER_LIST_WIIMOTES_ROW_H
