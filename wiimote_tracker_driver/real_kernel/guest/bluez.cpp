#include "bluez.h"

#include "clock.h"

#include <stdexcept>
#include <string>
#include <vector>

namespace wiimote_tracker::real_kernel {
namespace {

constexpr double kServiceStart = 20.0;  // [s] For a service to start.

}  // namespace

Bluez::Bluez() : bus_({"dbus-daemon", "--config-file=/etc/dbus.conf", "--nofork"}) {
  const auto listens = [] {
    return Process({"test", "-S", "/run/dbus/system_bus_socket"}).wait(1) == 0;
  };
  if (!waitFor(listens, kServiceStart))
    throw std::runtime_error("dbus-daemon does not start: " + bus_.output());
  restart();
}

void Bluez::restart() {
  daemon_.reset();
  daemon_ = std::make_unique<Process>(std::vector<std::string>{"bluetoothd", "-n"});
  if (!daemon_->says("management interface", kServiceStart))
    throw std::runtime_error("bluetoothd does not start: " + daemon_->output() + bus_.output());
}

}  // namespace wiimote_tracker::real_kernel
