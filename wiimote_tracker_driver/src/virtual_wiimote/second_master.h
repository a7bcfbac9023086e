#pragma once

#include "wiimote_tracker_driver/virtual_wiimote/device.h"

#include <cstdint>
#include <vector>

namespace wiimote_tracker::virtual_wiimote {

/// Simulates Linux's driver hid-wiimote and the desktop above it, with a remote that another
/// program uses through hidraw, as observed with kernels 6.1 and 6.12. All of its reports switch
/// the motor off. Unlike the kernel it does not wait for answers.
class SecondMaster {
 public:
  /// One sample has passed. @returns reports to the remote.
  std::vector<Bytes> tick();

  /// The remote has sent a report. @returns reports in reply.
  std::vector<Bytes> receive(const Bytes& report) const;

 private:
  std::uint64_t samples_ = 0;
  std::uint8_t mode_ = 0x30;
};

}  // namespace wiimote_tracker::virtual_wiimote
