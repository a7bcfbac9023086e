#include "wiimote/factory_calibration.h"

#include "wiimote_tracker_driver/protocol/output_reports.h"

#include <algorithm>
#include <array>

namespace wiimote_tracker::wiimote {
namespace {

struct EepromBlock {
  std::uint32_t address;
  std::size_t size;
};
// In the order of FactoryCalibration::Block.
constexpr std::array<EepromBlock, 4> kBlocks{
    {{protocol::kIrCalibrationAddress, protocol::kIrCalibrationBlockSize},
     {protocol::kIrCalibrationCopyAddress, protocol::kIrCalibrationBlockSize},
     {protocol::kAccelerometerAddress, protocol::kAccelerometerBlockSize},
     {protocol::kAccelerometerCopyAddress, protocol::kAccelerometerBlockSize}}};

template <std::size_t N>
std::array<std::uint8_t, N> firstBytes(const protocol::MemoryPacket& packet) {
  std::array<std::uint8_t, N> bytes{};
  std::copy_n(packet.data.begin(), N, bytes.begin());
  return bytes;
}

}  // namespace

protocol::Report FactoryCalibration::request() const {
  if (complete())
    return {};
  const EepromBlock& block = kBlocks[static_cast<std::size_t>(block_)];
  return protocol::readMemory(protocol::Space::kEeprom, block.address,
                              static_cast<std::uint16_t>(block.size));
}

bool FactoryCalibration::take(const protocol::MemoryPacket& packet) {
  if (complete())
    return false;
  const EepromBlock& block = kBlocks[static_cast<std::size_t>(block_)];
  if (packet.address != block.address || (packet.error == 0 && packet.size != block.size))
    return false;
  if (packet.error == 0 && decode(packet))
    skip();
  else
    block_ = static_cast<Block>(static_cast<int>(block_) + 1);
  return true;
}

bool FactoryCalibration::decode(const protocol::MemoryPacket& packet) {
  if (block_ <= Block::kIrCopy) {
    ir_ = protocol::decodeIrCalibrationBlock(firstBytes<protocol::kIrCalibrationBlockSize>(packet));
    return ir_.has_value();
  }
  accelerometer_was_read_ = true;
  accelerometer_ =
      protocol::decodeAccelerometerBlock(firstBytes<protocol::kAccelerometerBlockSize>(packet));
  return accelerometer_.has_value();
}

void FactoryCalibration::skip() {
  block_ = block_ <= Block::kIrCopy ? Block::kAccelerometer : Block::kNone;
}

}  // namespace wiimote_tracker::wiimote
