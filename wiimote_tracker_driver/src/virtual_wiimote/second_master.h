#ifndef WIIMOTE_TRACKER_DRIVER_VIRTUAL_WIIMOTE_SECOND_MASTER_H
#define WIIMOTE_TRACKER_DRIVER_VIRTUAL_WIIMOTE_SECOND_MASTER_H

#include "wiimote_tracker_driver/virtual_wiimote/device.h"

#include <cstdint>
#include <vector>

namespace wiimote_tracker::virtual_wiimote {

/// What Linux's driver hid-wiimote and the desktop above it say to a remote that somebody else uses
/// through hidraw, as seen with the kernels 6.1 and 6.12. Each of its reports carries its own idea
/// of the motor: off. Unlike the kernel it waits for no answer.
class SecondMaster {
 public:
  /// Another sample of the remote has passed. @returns what it says to the remote.
  std::vector<Bytes> tick();

  /// It hears what the remote says. @returns what it says to that.
  std::vector<Bytes> hear(const Bytes& report) const;

 private:
  std::uint64_t samples_ = 0;
  std::uint8_t mode_ = 0x30;
};

}  // namespace wiimote_tracker::virtual_wiimote

#endif  // WIIMOTE_TRACKER_DRIVER_VIRTUAL_WIIMOTE_SECOND_MASTER_H
