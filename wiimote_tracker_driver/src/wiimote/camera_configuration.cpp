#include "wiimote/camera_configuration.h"

#include "wiimote_tracker_driver/protocol/output_reports.h"

#include <algorithm>
#include <array>

namespace wiimote_tracker::wiimote {
namespace {

using protocol::Report;
using protocol::Space;
using protocol::writeRegisters;

struct Area {
  std::uint32_t address;
  std::uint16_t size;
};
// The first reaches from the control register to the mode register.
constexpr std::array<Area, CameraConfiguration::kReads> kAreas{{{protocol::kIrControlRegister, 4},
                                                                {protocol::kIrBlock1Register, 9},
                                                                {protocol::kIrBlock2Register, 2}}};
constexpr std::size_t kModeOffset = protocol::kIrModeRegister - protocol::kIrControlRegister;

const Area& area(int index) {
  return kAreas[static_cast<std::size_t>(index)];
}

template <std::size_t N>
bool holds(const protocol::MemoryPacket& packet, const std::array<std::uint8_t, N>& block) {
  return std::equal(block.begin(), block.end(), packet.data.begin());
}

}  // namespace

Report CameraConfiguration::write(int index) const {
  switch (index) {
    case 0:
      return writeRegisters(protocol::kIrControlRegister, std::array{protocol::kIrControlSetup});
    case 1:
      return writeRegisters(protocol::kIrBlock1Register, sensitivity_.block1);
    case 2:
      return writeRegisters(protocol::kIrBlock2Register, sensitivity_.block2);
    case 3:
      return writeRegisters(protocol::kIrModeRegister,
                            std::array{static_cast<std::uint8_t>(format_)});
    default:
      return writeRegisters(protocol::kIrControlRegister, std::array{protocol::kIrControlRun});
  }
}

Report CameraConfiguration::read(int index) const {
  return protocol::readMemory(Space::kRegisters, area(index).address, area(index).size);
}

bool CameraConfiguration::answers(int index, const protocol::MemoryPacket& packet) const {
  return packet.address == (area(index).address & 0xffff) &&
         (packet.error != 0 || packet.size == area(index).size);
}

const char* CameraConfiguration::fault(int index, const protocol::MemoryPacket& packet) const {
  if (packet.error != 0)
    return "the camera was switched off";
  if (index == 0) {
    if (packet.data[0] != protocol::kIrControlRun)
      return "the camera was stopped";
    if (packet.data[kModeOffset] != static_cast<std::uint8_t>(format_))
      return "the camera's format was changed";
    return nullptr;
  }
  const bool right =
      index == 1 ? holds(packet, sensitivity_.block1) : holds(packet, sensitivity_.block2);
  return right ? nullptr : "the camera's sensitivity was changed";
}

}  // namespace wiimote_tracker::wiimote
