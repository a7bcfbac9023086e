#include "scenarios.h"

#include "file_descriptor.h"
#include "kernel.h"
#include "streaming.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <string>
#include <vector>

namespace wiimote_tracker::real_kernel {
namespace {

using Bytes = PluggedRemote::Bytes;

Bytes writeCamera(std::uint8_t address, const Bytes& data) {
  Bytes report{0x16, 0x04, 0xb0, 0x00, address, static_cast<std::uint8_t>(data.size())};
  report.resize(22, 0);
  std::copy(data.begin(), data.end(), report.begin() + 6);
  return report;
}

/// What is sent, how the driver names the change of its configuration, and whether images with the
/// light stop.
struct Word {
  const char* what;
  Bytes report;
  const char* found;
  bool stops;
};

constexpr char kOff[] = "the camera was switched off";
constexpr char kLogic[] = "the camera's logic was switched off";
constexpr char kStopped[] = "the camera was stopped";
constexpr char kFormat[] = "the camera's format was changed";
constexpr char kSensitivity[] = "the camera's sensitivity was changed";
constexpr char kMode[] = "the report mode was changed";

// Changes that stop the images are corrected at once. Others show only when the camera's registers
// are read back: each third of them every 6 s, plus some round trips [s].
constexpr double kWhenStopped = 1.0;
constexpr double kWhenSilent = 6.5;

std::vector<Word> words() {
  return {
      {"asks for the status", {0x15, 0x00}, "", true},
      {"sets mode 0x30", {0x12, 0x00, 0x30}, "", true},
      {"sets mode 0x37", {0x12, 0x04, 0x37}, kMode, true},
      {"wants changes only", {0x12, 0x00, 0x33}, "", true},
      {"reads 256 bytes of the EEPROM", {0x17, 0x00, 0x00, 0x00, 0x00, 0x01, 0x00}, "", true},
      {"switches the LEDs", {0x11, 0xf0}, "", true},
      {"switches the camera's clock off", {0x13, 0x00}, kOff, true},
      {"switches the camera's logic off", {0x1a, 0x00}, kLogic, true},
      {"stops the camera", writeCamera(0x30, {1}), kStopped, true},
      {"sets the camera's gain limit to 0", writeCamera(0x1a, {0}), kSensitivity, true},
      {"sets the camera's smallest spot", writeCamera(0x1b, {5}), kSensitivity, false},
      {"sets the first block of the sensitivity",
       writeCamera(0x00, {0x02, 0, 0, 0x71, 0x01, 0, 0xaa, 0, 0x64}), kSensitivity, false},
      {"sets the camera to the basic format", writeCamera(0x33, {1}), kFormat, false},
      {"sets the camera to the full format", writeCamera(0x33, {5}), kFormat, false},
  };
}

}  // namespace

void anotherProgram(Checks& checks) {
  Streaming streaming(checks);
  const FileDescriptor node(::open(hidrawOf(kAddress).c_str(), O_RDWR | O_CLOEXEC));
  for (const Word& word : words()) {
    const auto say = [&] {
      const Bytes& report = word.report;
      if (::write(node.get(), report.data(), report.size()) != static_cast<ssize_t>(report.size()))
        throw std::runtime_error("cannot write to the hidraw node");
    };
    const std::string name = std::string("another program ") + word.what;
    if (word.found[0] != '\0')
      checks.restores(name, streaming.driver, say, word.found,
                      word.stops ? kWhenStopped : kWhenSilent);
    if (word.stops)
      checks.recovers(name, streaming.driver, say, 5);
  }
  checks.check("the clock epoch is the same", streaming.driver.link().clock_epoch == 0,
               std::to_string(streaming.driver.link().clock_epoch));
}

}  // namespace wiimote_tracker::real_kernel
