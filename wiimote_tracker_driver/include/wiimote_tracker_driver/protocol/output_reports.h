#pragma once

#include "wiimote_tracker_driver/protocol/report.h"

#include <array>
#include <cstddef>
#include <cstdint>

/// Reports of the host (wiibrew.org/wiki/Wiimote). Each asks for an acknowledgement (0x22) where
/// the remote does not send one anyway, and carries the motor's state: here off, see kRumbleBit.
namespace wiimote_tracker::protocol {

constexpr std::uint8_t kRumbleId = 0x10;
constexpr std::uint8_t kLedsId = 0x11;
constexpr std::uint8_t kReportModeId = 0x12;
constexpr std::uint8_t kIrClockId = 0x13;
constexpr std::uint8_t kStatusRequestId = 0x15;
constexpr std::uint8_t kWriteMemoryId = 0x16;
constexpr std::uint8_t kReadMemoryId = 0x17;
constexpr std::uint8_t kIrLogicId = 0x1a;

/// Bit of the second byte of every output report: the motor runs. Set it in each report meanwhile.
constexpr std::uint8_t kRumbleBit = 0x01;

enum class Space : std::uint8_t { kEeprom = 0x00, kRegisters = 0x04 };

/// Sets only the motor. Never acknowledged.
Report setRumble(bool rumble);

/// Player LEDs 1..4 in bits 0..3.
Report setLeds(std::uint8_t leds);

/// Selects the data report: `continuous` at every sample, else on changes only.
Report setReportMode(std::uint8_t data_report_id, bool continuous);

Report setIrClock(bool on);
Report setIrLogic(bool on);

/// Answered by a Status.
Report requestStatus();

/// Answered by MemoryPackets of up to 16 bytes.
Report readMemory(Space space, std::uint32_t address, std::uint16_t size);

/// Answered by an Acknowledgement. `data`: 1..16 bytes. @throws std::invalid_argument otherwise.
Report writeMemory(Space space, std::uint32_t address, const std::uint8_t* data, std::size_t size);

/// The same, to registers.
template <std::size_t N>
Report writeRegisters(std::uint32_t address, const std::array<std::uint8_t, N>& data) {
  return writeMemory(Space::kRegisters, address, data.data(), N);
}

}  // namespace wiimote_tracker::protocol
