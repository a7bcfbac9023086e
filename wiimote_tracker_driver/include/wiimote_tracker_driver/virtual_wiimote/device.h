#ifndef WIIMOTE_TRACKER_DRIVER_VIRTUAL_WIIMOTE_DEVICE_H
#define WIIMOTE_TRACKER_DRIVER_VIRTUAL_WIIMOTE_DEVICE_H

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace wiimote_tracker::virtual_wiimote {

/// One HID report as it crosses the wire: report id first, no 0xa1/0xa2.
using Bytes = std::vector<std::uint8_t>;

/// A light as it falls on the sensor, before the sensor's own processing.
/// Coordinates are the sensor's: x to the camera's right 0..1023, y UP 0..767, continuous.
struct Light {
  double x = 0.0;
  double y = 0.0;
  double size = 2.0;        ///< 0..15, as reported in extended mode.
  double brightness = 1.0;  ///< Any scale; only the order counts.
};

/// What the device senses at one instant.
struct Senses {
  std::vector<Light> lights;  ///< Any number; the device reports the four brightest in its image.
  std::array<double, 3> acceleration{0.0, 0.0,
                                     1.0};  ///< Specific force [g]: +x left, +y rear, +z up.
  std::uint16_t buttons = 0;  ///< First byte in bits 8..15, second in 0..7, as on the wire.
};

/// The device side of the Wii Remote's HID protocol: registers, EEPROM, camera enable sequence,
/// report modes 0x30..0x37, status, acknowledgements and error codes. Pure logic: no I/O, no clock,
/// no thread. Registers other than the camera's and those of a Nunchuk that is plugged in give
/// error 7; without one, extension bytes are ff. Where real remotes and their descriptions differ
/// it takes the stricter side: the camera sees only with 0x13 and 0x1a on, both sensitivity blocks
/// written, a mode, and register 0x30 = 8.
class Device {
 public:
  struct Options {
    std::uint8_t battery = 0xa0;  ///< Raw level.
  };

  Device();
  explicit Device(const Options& options);
  ~Device();

  /// The host sent an output report. @returns the device's answers, in order (often none). Of a
  /// read of more than 16 bytes only the first packet; sample() returns the others. What the device
  /// does not understand it ignores.
  std::vector<Bytes> handleOutput(const Bytes& report);

  /// One sensor instant. @returns the data report that the present mode sends, or nothing when
  /// nothing changed and the host asked for changes only; the next packet of a read in progress
  /// takes the place of a data report.
  std::optional<Bytes> sample(const Senses& senses);

  /// Player LEDs 1..4 in bits 0..3, as last set by the host.
  std::uint8_t leds() const;

  /// Plugs a Nunchuk in, or pulls it out. @returns the status report that tells the host, or
  /// nothing when nothing changed. Data reports then stop until the host sets a mode.
  std::optional<Bytes> setNunchuk(bool plugged);

  /// The batteries were taken out and put back: all state is as after switching on.
  void powerCycle();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace wiimote_tracker::virtual_wiimote

#endif  // WIIMOTE_TRACKER_DRIVER_VIRTUAL_WIIMOTE_DEVICE_H
