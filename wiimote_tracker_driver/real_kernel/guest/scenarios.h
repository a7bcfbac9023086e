#pragma once

#include "checks.h"

#include <vector>

namespace wiimote_tracker::real_kernel {

/// Events on a Linux machine that affect a Wii Remote. Each scenario has a freshly booted kernel.
struct Scenario {
  const char* name;
  void (*run)(Checks& checks);
  const char* guest = "hid";  ///< What the kernel and the file system must have: see guests.py.
};

const std::vector<Scenario>& scenarios();

// The kernel's own driver uses the remote while ours streams (kernel_use.cpp).
void battery(Checks& checks);
void evdev(Checks& checks);
void extension(Checks& checks);
void otherFormats(Checks& checks);
void leds(Checks& checks);
void rebind(Checks& checks);

/// Another program opens the same hidraw node, without asking for our lock, and writes to the
/// remote.
void anotherProgram(Checks& checks);

/// A driver that may take any remote, and the first one does not answer.
void muteRemote(Checks& checks);

// Remotes in the air, the kernel's Bluetooth, and BlueZ (bluetooth.cpp).
void pairScenario(Checks& checks);
void pairRefused(Checks& checks);
void twoAdapters(Checks& checks);
void overHidp(Checks& checks);
void overUserspaceHid(Checks& checks);

// The virtual remote is used by libraries that others wrote for real ones (clients.cpp).

/// libxwiimote: through the kernel's driver and its input devices.
void xwiimoteClient(Checks& checks);
/// libcwiid: over L2CAP channels, without the kernel's driver.
void cwiidClient(Checks& checks);

}  // namespace wiimote_tracker::real_kernel
