#pragma once

#include "process.h"

#include <memory>

namespace wiimote_tracker::real_kernel {

/// bluetoothd and the message bus it needs.
class Bluez {
 public:
  /// @throws std::runtime_error if one does not start.
  Bluez();

  void restart();

 private:
  Process bus_;
  std::unique_ptr<Process> daemon_;
};

}  // namespace wiimote_tracker::real_kernel
