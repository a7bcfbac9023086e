#include "scenarios.h"

#include "clock.h"
#include "file_descriptor.h"
#include "kernel.h"
#include "streaming.h"

#include <fcntl.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

namespace wiimote_tracker::real_kernel {
namespace {

using Bytes = PluggedRemote::Bytes;
using State = wiimote::Link::State;

/// The kernel's report after each status while no program uses its input devices.
Bytes kernelsMode() {
  return {0x12, 0x00, 0x30};
}

/// @returns a file descriptor.
int openFile(const std::string& path) {
  const int fd = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  if (fd < 0)
    throw std::runtime_error("cannot open '" + path + "'");
  return fd;
}

}  // namespace

void battery(Checks& checks) {
  Streaming streaming(checks);
  const std::string file = batteryFileOf(kAddress);
  const double begin = now();
  checks.recovers(
      "battery read", streaming.driver, [&] { readLine(file); }, 20);
  const std::vector<PluggedRemote::Output> outputs = streaming.remote.outputs(begin);
  const auto resets = static_cast<std::size_t>(std::count_if(
      outputs.begin(), outputs.end(),
      [](const PluggedRemote::Output& output) { return output.report == kernelsMode(); }));
  checks.check("each time the kernel set its own mode", resets >= 20, count(resets, "times"));
  checks.recovers("battery read ten times in a row", streaming.driver, [&] {
    for (int i = 0; i < 10; ++i) {
      readLine(file);
      sleepFor(0.003 * i);
    }
  });
}

void evdev(Checks& checks) {
  Streaming streaming(checks);
  for (const char* name :
       {"Nintendo Wii Remote IR", "Nintendo Wii Remote Accelerometer", "Nintendo Wii Remote"}) {
    const std::string node = inputNodeOf(kAddress, name);
    const std::string thing = std::string("input device ") + name;
    FileDescriptor file;
    const double begin = now();
    checks.recovers(thing + " opened", streaming.driver, [&] { file.reset(openFile(node)); });
    checks.recovers(thing + " closed", streaming.driver, [&] { file.reset(); });
    if (std::string(name) == "Nintendo Wii Remote IR") {
      checks.check("the kernel had taken the camera",
                   streaming.remote.got({0x12, 0x00, 0x36}, begin) &&
                       streaming.remote.got({0x13, 0x00}, begin));
    }
  }
  checks.recovers(
      "all input devices opened and closed", streaming.driver,
      [] {
        for (const std::string& node : inputNodes())
          const FileDescriptor file(openFile(node));
      },
      20);
}

void extension(Checks& checks) {
  Streaming streaming(checks);
  bool plugged = false;
  const auto toggle = [&] { streaming.remote.setNunchuk(plugged = !plugged); };
  const double begin = now();
  checks.recovers("Nunchuk plugged in", streaming.driver, toggle);
  checks.check("the kernel had taken it",
               streaming.remote.got({0x16, 0x04, 0xa4, 0x00, 0xfb}, begin) &&
                   !inputNodeOf(kAddress, "Nintendo Wii Remote Nunchuk").empty(),
               inputNodeOf(kAddress, "Nintendo Wii Remote Nunchuk"));
  checks.recovers("Nunchuk pulled out and plugged in", streaming.driver, toggle, 20);
  streaming.remote.unplug();
  streaming.remote.setNunchuk(true);
  sleepFor(0.3);
  checks.recovers("plugged in with a Nunchuk", streaming.driver, [&] { streaming.remote.plug(); });
}

void otherFormats(Checks& checks) {
  for (const auto format : {protocol::IrFormat::kBasic, protocol::IrFormat::kFull}) {
    wiimote::Options options;
    options.ir_format = format;
    Streaming streaming(checks, options);
    const std::string name = format == protocol::IrFormat::kBasic ? "basic" : "full";
    checks.streams(name + " format: ", streaming.driver, 10.0);
    const std::string file = batteryFileOf(kAddress);
    checks.recovers(
        name + " format: battery read", streaming.driver, [&] { readLine(file); }, 10);
    FileDescriptor node;
    const std::string ir = inputNodeOf(kAddress, "Nintendo Wii Remote IR");
    checks.recovers(name + " format: input device of the camera opened", streaming.driver,
                    [&] { node.reset(openFile(ir)); });
    checks.recovers(name + " format: and closed", streaming.driver, [&] { node.reset(); });
  }
}

void leds(Checks& checks) {
  Streaming streaming(checks);
  const std::string file = ledFileOf(kAddress, 3);
  const double begin = now();
  checks.recovers("LED switched by the kernel", streaming.driver, [&] { writeText(file, "1"); });
  checks.check("the kernel had switched it", streaming.remote.got({0x11, 0x50}, begin));
}

void rebind(Checks& checks) {
  Streaming streaming(checks);
  const std::string name = hidNameOf(kAddress);
  writeText("/sys/bus/hid/drivers/wiimote/unbind", name);
  const bool searches = streaming.driver.waitForState(State::kSearching, 1.0);
  checks.check("the kernel's driver unbound: the driver searches", searches,
               streaming.driver.link().error);
  checks.recovers("the kernel's driver bound again", streaming.driver,
                  [&] { writeText("/sys/bus/hid/drivers/wiimote/bind", name); });
}

}  // namespace wiimote_tracker::real_kernel
