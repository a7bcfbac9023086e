#pragma once

#include "protocol/calibration_blocks.h"
#include "wiimote_tracker_driver/protocol/input_reports.h"
#include "wiimote_tracker_driver/protocol/report.h"

#include <optional>

namespace wiimote_tracker::wiimote {

/// Reads the factory calibration of camera and accelerometer from the remote's EEPROM, and the copy
/// of each block that is damaged. If both are damaged there is no calibration; that is no error.
class FactoryCalibration {
 public:
  bool complete() const { return block_ == Block::kNone; }

  /// The next read request; empty when complete().
  protocol::Report request() const;

  /// @returns whether the packet answers request(); then there is another request, or it is
  /// complete().
  bool take(const protocol::MemoryPacket& packet);

  /// Gives up the present block and its copy.
  void skip();

  const std::optional<protocol::IrCalibration>& ir() const { return ir_; }
  const std::optional<protocol::AccelerometerCalibration>& accelerometer() const {
    return accelerometer_;
  }
  /// Whether the accelerometer's block or its copy has been read, damaged or not.
  bool accelerometerWasRead() const { return accelerometer_was_read_; }

 private:
  enum class Block { kIr, kIrCopy, kAccelerometer, kAccelerometerCopy, kNone };

  bool decode(const protocol::MemoryPacket& packet);

  Block block_ = Block::kIr;
  std::optional<protocol::IrCalibration> ir_;
  std::optional<protocol::AccelerometerCalibration> accelerometer_;
  bool accelerometer_was_read_ = false;
};

}  // namespace wiimote_tracker::wiimote
