#include "wiimote_tracker_driver/protocol/output_reports.h"

#include <stdexcept>

namespace wiimote_tracker::protocol {
namespace {

constexpr std::uint8_t kAcknowledge = 0x02;
constexpr std::uint8_t kOn = 0x04;

std::uint8_t flags(bool rumble, int others) {
  return static_cast<std::uint8_t>((rumble ? kRumbleBit : 0) | others);
}

Report memoryReport(std::uint8_t id, Space space, std::uint32_t address, bool rumble) {
  return {id, flags(rumble, static_cast<int>(space)), static_cast<std::uint8_t>(address >> 16),
          static_cast<std::uint8_t>(address >> 8), static_cast<std::uint8_t>(address)};
}

}  // namespace

Report setRumble(bool rumble) {
  return {kRumbleId, flags(rumble, 0)};
}

Report setLeds(std::uint8_t leds, bool rumble) {
  return {kLedsId, flags(rumble, (leds & 0x0f) << 4 | kAcknowledge)};
}

Report setReportMode(std::uint8_t data_report_id, bool continuous, bool rumble) {
  return {kReportModeId, flags(rumble, kAcknowledge | (continuous ? kOn : 0)), data_report_id};
}

Report setIrClock(bool on, bool rumble) {
  return {kIrClockId, flags(rumble, kAcknowledge | (on ? kOn : 0))};
}

Report setIrLogic(bool on, bool rumble) {
  return {kIrLogicId, flags(rumble, kAcknowledge | (on ? kOn : 0))};
}

Report requestStatus(bool rumble) {
  return {kStatusRequestId, flags(rumble, 0)};
}

Report readMemory(Space space, std::uint32_t address, std::uint16_t size, bool rumble) {
  Report report = memoryReport(kReadMemoryId, space, address, rumble);
  report.bytes[5] = static_cast<std::uint8_t>(size >> 8);
  report.bytes[6] = static_cast<std::uint8_t>(size);
  report.size = 7;
  return report;
}

Report writeMemory(Space space,
                   std::uint32_t address,
                   const std::uint8_t* data,
                   std::size_t size,
                   bool rumble) {
  if (size < 1 || size > 16)
    throw std::invalid_argument("a memory write has 1 to 16 bytes");
  Report report = memoryReport(kWriteMemoryId, space, address, rumble);
  report.bytes[5] = static_cast<std::uint8_t>(size);
  std::copy_n(data, size, report.bytes.begin() + 6);
  report.size = 22;
  return report;
}

}  // namespace wiimote_tracker::protocol
