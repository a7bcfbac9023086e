#pragma once

#include "wiimote_tracker_driver/protocol/input_reports.h"
#include "wiimote_tracker_driver/protocol/ir_camera.h"
#include "wiimote_tracker_driver/protocol/report.h"

namespace wiimote_tracker::wiimote {

/// The wanted contents of the camera's registers: the reports that write them and read them back.
class CameraConfiguration {
 public:
  CameraConfiguration(const protocol::IrSensitivity& sensitivity, protocol::IrFormat format)
      : sensitivity_(sensitivity), format_(format) {}

  /// Stop, two sensitivity blocks, format, run: in this order, each after the acknowledgement of
  /// the one before. Meanwhile the camera is stopped.
  static constexpr int kWrites = 5;
  protocol::Report write(int index) const;

  /// Control and format, then either block. Each is answered by one packet.
  static constexpr int kReads = 3;
  protocol::Report read(int index) const;

  /// Whether the packet answers read(index), not a request of another program.
  bool answers(int index, const protocol::MemoryPacket& packet) const;

  /// The difference that this answer to read(index) shows, a phrase; null when there is none.
  const char* fault(int index, const protocol::MemoryPacket& packet) const;

 private:
  protocol::IrSensitivity sensitivity_;
  protocol::IrFormat format_;
};

}  // namespace wiimote_tracker::wiimote
