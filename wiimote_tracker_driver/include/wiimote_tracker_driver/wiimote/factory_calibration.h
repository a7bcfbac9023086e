#ifndef WIIMOTE_TRACKER_DRIVER_WIIMOTE_FACTORY_CALIBRATION_H
#define WIIMOTE_TRACKER_DRIVER_WIIMOTE_FACTORY_CALIBRATION_H

#include "wiimote_tracker_driver/protocol/accelerometer.h"
#include "wiimote_tracker_driver/protocol/input_reports.h"
#include "wiimote_tracker_driver/protocol/ir_calibration.h"
#include "wiimote_tracker_driver/protocol/report.h"

#include <optional>

namespace wiimote_tracker::wiimote {

/// Reads what the factory has measured from the remote's EEPROM: camera, then accelerometer, and
/// the copy of each where the first is damaged. Where both are, there is nothing; that is no error.
class FactoryCalibration {
 public:
  bool complete() const { return block_ == Block::kNone; }

  /// The read that is to be answered. Only while not complete().
  protocol::Report request() const;

  /// @returns whether the packet is the answer; then there is another request, or all is complete.
  bool take(const protocol::MemoryPacket& packet);

  /// There will be no answer.
  void skip();

  const std::optional<protocol::IrCalibration>& ir() const { return ir_; }
  const std::optional<protocol::AccelerometerCalibration>& accelerometer() const {
    return accelerometer_;
  }

 private:
  enum class Block { kIr, kIrCopy, kAccelerometer, kAccelerometerCopy, kNone };

  bool decode(const protocol::MemoryPacket& packet);

  Block block_ = Block::kIr;
  std::optional<protocol::IrCalibration> ir_;
  std::optional<protocol::AccelerometerCalibration> accelerometer_;
};

}  // namespace wiimote_tracker::wiimote

#endif  // WIIMOTE_TRACKER_DRIVER_WIIMOTE_FACTORY_CALIBRATION_H
