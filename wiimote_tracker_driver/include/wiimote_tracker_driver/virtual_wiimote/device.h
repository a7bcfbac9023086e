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
  /// Of its image as reported in extended mode, 0..15: about so many of the sensor's 128 x 96 cells
  /// across. Not given: it follows from the brightness.
  std::optional<double> size;
  /// Irradiance at the camera; 1 is the Wii's sensor bar (one of its two clusters of LEDs) seen
  /// from 1 m, so a lamp like that z metres away has 1 / z^2. What falls below a threshold that
  /// hangs on the camera's sensitivity is not seen: 0.12 at level 1 of the console, 0.0060 at the
  /// most sensitive setting known.
  double brightness = 1.0;
};

/// What the device senses at one instant.
struct Senses {
  std::vector<Light> lights;  ///< Any number; the device reports the four brightest in its image.
  std::array<double, 3> acceleration{0.0, 0.0,
                                     1.0};  ///< Specific force [g]: +x left, +y rear, +z up.
  std::uint16_t buttons = 0;  ///< First byte in bits 8..15, second in 0..7, as on the wire.
};

/// Four points of the sensor's image [px, y up], as the factory's calibration of the infrared
/// camera holds them.
using FactoryPoints = std::array<std::array<int, 2>, 4>;

/// Factory points as a remote of its own might have them: a rectangle that fills four fifths of the
/// image, about (`centre_x`, `centre_y`) [px, y up], each corner off by a few pixels as drawn from
/// `seed`. How the factory finds the points is not known; in the one real block that is, their mean
/// is (525, 354).
FactoryPoints factoryPoints(double centre_x, double centre_y, std::uint32_t seed);

/// The device side of the Wii Remote's HID protocol: registers, EEPROM, camera enable sequence,
/// report modes 0x30..0x37, 0x3d and the pair 0x3e/0x3f, status, acknowledgements and error codes.
/// Pure logic: no I/O, no clock, no thread. Registers other than the camera's, those of a Nunchuk
/// that is plugged in and those of a MotionPlus that is built in give error 7; without an extension
/// its bytes are ff. Where real remotes and their descriptions differ it takes the stricter side:
/// the camera sees only with 0x13 and 0x1a on, both sensitivity blocks written, a mode, and
/// register 0x30 = 8.
class Device {
 public:
  struct Options {
    std::uint8_t battery = 0xa0;  ///< Raw level; below 0x20 the status says that it is low.
    /// Those of a real remote.
    FactoryPoints factory_points{{{136, 645}, {907, 650}, {919, 63}, {140, 57}}};
    bool motion_plus = false;  ///< Built in, as in the RVL-CNT-01-TR.
    /// The slot in which a light that is new or has returned is reported: without this the first
    /// free one; with it any free one, drawn from this seed. Hosts must not rely on either.
    std::optional<std::uint32_t> slot_seed;
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

  /// Whether the motor runs: every output report carries its state.
  bool rumble() const;

  /// The batteries' raw level from now on.
  void setBattery(std::uint8_t level);

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
