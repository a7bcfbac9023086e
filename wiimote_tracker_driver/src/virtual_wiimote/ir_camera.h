#ifndef WIIMOTE_TRACKER_DRIVER_VIRTUAL_WIIMOTE_IR_CAMERA_H
#define WIIMOTE_TRACKER_DRIVER_VIRTUAL_WIIMOTE_IR_CAMERA_H

#include "wiimote_tracker_driver/virtual_wiimote/device.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace wiimote_tracker::virtual_wiimote {

/// The infrared camera behind the remote's internal bus: its registers, the rules by which it
/// starts to see, and what it makes of the lights in its image.
class IrCamera {
 public:
  /// Report 0x13: the camera answers on the bus only while this is on.
  void setClock(bool on) { clock_ = on; }
  /// Report 0x1a.
  void setLogic(bool on) { logic_ = on; }

  bool onBus() const { return clock_; }

  /// Register access; the host may do this only while onBus(). Registers repeat every 256 bytes.
  void write(std::uint32_t address, std::uint8_t value) { registers_[address & 0xff] = value; }
  std::uint8_t read(std::uint32_t address) const { return registers_[address & 0xff]; }

  /// One image. Keeps a light in its slot while it is followed from image to image.
  void look(const std::vector<Light>& lights);

  /// Appends the first `size` bytes of infrared data as a data report carries them.
  void appendData(std::size_t size, Bytes& report) const;

 private:
  struct Spot {
    bool lit = false;       ///< Seen in the last image.
    bool ever_lit = false;  ///< Seen since the remote was switched on.
    int x = 0;
    int y = 0;
    int size = 0;
    int intensity = 0;
  };

  bool seeing() const;
  void follow(std::vector<Spot>& seen);
  void fillBasic();
  void fillExtended();
  void fillFull();

  bool clock_ = false;
  bool logic_ = false;
  std::array<std::uint8_t, 256> registers_{};
  std::array<Spot, 4> slots_{};
};

}  // namespace wiimote_tracker::virtual_wiimote

#endif  // WIIMOTE_TRACKER_DRIVER_VIRTUAL_WIIMOTE_IR_CAMERA_H
