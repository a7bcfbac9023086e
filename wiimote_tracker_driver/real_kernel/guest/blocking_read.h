#ifndef WIIMOTE_TRACKER_DRIVER_REAL_KERNEL_GUEST_BLOCKING_READ_H
#define WIIMOTE_TRACKER_DRIVER_REAL_KERNEL_GUEST_BLOCKING_READ_H

#include <string>

namespace wiimote_tracker::real_kernel {

/// Whether a program that waits in a read of a Bluetooth socket keeps that socket locked. Then the
/// kernel can deliver nothing more, to any socket: so in Linux 5.10.223 (Debian 11), which has
/// "Bluetooth: af_bluetooth: Fix Use-After-Free in bt_sock_recvmsg" without the later "Fix
/// deadlock". @param address of a remote that can be connected to
/// @throws std::runtime_error if it cannot.
bool readsLockTheSocket(const std::string& address);

}  // namespace wiimote_tracker::real_kernel

#endif  // WIIMOTE_TRACKER_DRIVER_REAL_KERNEL_GUEST_BLOCKING_READ_H
