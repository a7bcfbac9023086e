#ifndef WIIMOTE_TRACKER_DRIVER_WIIMOTE_CAMERA_CONFIGURATION_H
#define WIIMOTE_TRACKER_DRIVER_WIIMOTE_CAMERA_CONFIGURATION_H

#include "wiimote_tracker_driver/protocol/input_reports.h"
#include "wiimote_tracker_driver/protocol/ir_camera.h"
#include "wiimote_tracker_driver/protocol/report.h"

namespace wiimote_tracker::wiimote {

/// What the camera's registers are to hold: the reports that write it, and those that read it back.
class CameraConfiguration {
 public:
  CameraConfiguration(const protocol::IrSensitivity& sensitivity, protocol::IrFormat format)
      : sensitivity_(sensitivity), format_(format) {}

  /// Stop, two blocks of sensitivity, format, run: in this order, each after the acknowledgement of
  /// the one before. The camera sees nothing meanwhile.
  static constexpr int kWrites = 5;
  protocol::Report write(int index) const;

  /// Control and format, then either block. Each is answered by one packet.
  static constexpr int kReads = 3;
  protocol::Report read(int index) const;

  /// Whether the packet answers read(index), rather than somebody else's question.
  bool answers(int index, const protocol::MemoryPacket& packet) const;

  /// What this answer to read(index) says is wrong, one phrase; null when all is as it should be.
  const char* fault(int index, const protocol::MemoryPacket& packet) const;

 private:
  protocol::IrSensitivity sensitivity_;
  protocol::IrFormat format_;
};

}  // namespace wiimote_tracker::wiimote

#endif  // WIIMOTE_TRACKER_DRIVER_WIIMOTE_CAMERA_CONFIGURATION_H
