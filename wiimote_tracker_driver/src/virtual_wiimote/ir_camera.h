#pragma once

#include "image_sensor.h"
#include "wiimote_tracker_driver/virtual_wiimote/device.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <random>
#include <vector>

namespace wiimote_tracker::virtual_wiimote {

/// Two points in five bytes, as in the basic format and in the factory's blocks.
std::array<std::uint8_t, 10> basicFormat(const FactoryPoints& points);

/// The infrared camera on the remote's internal bus: its registers, the conditions under which it
/// works, and its detection of lights.
class IrCamera {
 public:
  /// Number of registers in data reports.
  static constexpr std::size_t kDataSize = 36;
  using Data = std::array<std::uint8_t, kDataSize>;

  /// `slot_seed`: see Device::Options.
  explicit IrCamera(const std::optional<std::uint32_t>& slot_seed);

  /// Report 0x13: the camera answers on the bus only while this is on.
  void setClock(bool on) { clock_ = on; }
  /// Report 0x1a.
  void setLogic(bool on) { logic_ = on; }

  bool onBus() const { return clock_; }

  /// Register access; allowed only while onBus(). Registers repeat every 256 bytes.
  void write(std::uint32_t address, std::uint8_t value) { registers_[address & 0xff] = value; }
  std::uint8_t read(std::uint32_t address) const { return registers_[address & 0xff]; }

  /// Takes one image. A light keeps its slot while it is tracked from image to image.
  void takeImage(const std::vector<Light>& lights);

  /// The last image as in data reports, from the first byte; ff while the camera does not work.
  Data data() const;

 private:
  struct Slot {
    bool lit = false;       ///< Detected in the last image.
    bool ever_lit = false;  ///< Detected since power-up.
    Blob blob;
  };

  bool works() const;
  void assignSlots(const std::vector<Blob>& seen);
  std::size_t chooseFree(const std::array<bool, 4>& taken);
  void fillBasic();
  void fillExtended();
  void fillFull();
  static void fillSlot(const Slot& slot, std::size_t size, std::uint8_t* out);

  bool clock_ = false;
  bool logic_ = false;
  std::array<std::uint8_t, 256> registers_{};
  std::array<Slot, 4> slots_{};
  bool draws_slots_;
  std::mt19937 random_;
};

}  // namespace wiimote_tracker::virtual_wiimote
