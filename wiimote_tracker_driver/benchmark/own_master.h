#pragma once

#include "process.h"

namespace wiimote_tracker {

/// A ROS master for this process only, at a free port, independent of a running system.
class OwnMaster {
 public:
  /// Starts it for this process and its children. Returns at once.
  /// @throws std::runtime_error when no port is free.
  OwnMaster();

  /// Initialises ROS in this process and waits for the master; no thread is started.
  /// @throws std::runtime_error when there is no program rosmaster.
  void connect();

 private:
  Process process_;
};

}  // namespace wiimote_tracker
