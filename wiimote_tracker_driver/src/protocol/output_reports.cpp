#include "wiimote_tracker_driver/protocol/output_reports.h"

#include <stdexcept>

namespace wiimote_tracker::protocol {
namespace {

constexpr std::uint8_t kAcknowledge = 0x02;
constexpr std::uint8_t kOn = 0x04;

std::uint8_t switched(bool on) {
  return static_cast<std::uint8_t>(kAcknowledge | (on ? kOn : 0));
}

Report memoryReport(std::uint8_t id, Space space, std::uint32_t address) {
  return {id, static_cast<std::uint8_t>(space), static_cast<std::uint8_t>(address >> 16),
          static_cast<std::uint8_t>(address >> 8), static_cast<std::uint8_t>(address)};
}

}  // namespace

Report setRumble(bool rumble) {
  return {kRumbleId, rumble ? kRumbleBit : std::uint8_t{0}};
}

Report setLeds(std::uint8_t leds) {
  return {kLedsId, static_cast<std::uint8_t>((leds & 0x0f) << 4 | kAcknowledge)};
}

Report setReportMode(std::uint8_t data_report_id, bool continuous) {
  return {kReportModeId, switched(continuous), data_report_id};
}

Report setIrClock(bool on) {
  return {kIrClockId, switched(on)};
}

Report setIrLogic(bool on) {
  return {kIrLogicId, switched(on)};
}

Report requestStatus() {
  return {kStatusRequestId, 0};
}

Report readMemory(Space space, std::uint32_t address, std::uint16_t size) {
  Report report = memoryReport(kReadMemoryId, space, address);
  report.bytes[5] = static_cast<std::uint8_t>(size >> 8);
  report.bytes[6] = static_cast<std::uint8_t>(size);
  report.size = 7;
  return report;
}

Report writeMemory(Space space, std::uint32_t address, const std::uint8_t* data, std::size_t size) {
  if (size < 1 || size > 16)
    throw std::invalid_argument("a memory write has 1 to 16 bytes");
  Report report = memoryReport(kWriteMemoryId, space, address);
  report.bytes[5] = static_cast<std::uint8_t>(size);
  std::copy_n(data, size, report.bytes.begin() + 6);
  report.size = 22;
  return report;
}

}  // namespace wiimote_tracker::protocol
