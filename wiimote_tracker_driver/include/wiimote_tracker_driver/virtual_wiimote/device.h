#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace wiimote_tracker::virtual_wiimote {

/// One HID report as it crosses the wire: report id first, no 0xa1/0xa2.
using Bytes = std::vector<std::uint8_t>;

/// A light on the sensor, before the sensor's processing. Sensor axes: x to the camera's right
/// 0..1023, y UP 0..767, continuous.
struct Light {
  double x = 0.0;
  double y = 0.0;
  /// Size in extended mode, 0..15: about the diameter in the sensor's 128 x 96 cells. If not set,
  /// it is computed from the brightness.
  std::optional<double> size;
  /// Irradiance at the camera: 1 for one LED cluster of the Wii's sensor bar at 1 m, 1 / z^2 at z
  /// metres. Thresholds of detection: 0.12 at the console's level 1, 0.0087 at its level 5, 0.0060
  /// at `max`.
  double brightness = 1.0;
};

/// Input of the device's sensors at one time.
struct Senses {
  std::vector<Light> lights;  ///< Any number; the device reports the four brightest.
  /// Specific force [g]: +x left, +y rear, +z up.
  std::array<double, 3> acceleration{0.0, 0.0, 1.0};
  std::uint16_t buttons = 0;  ///< First byte in bits 8..15, second in 0..7, as on the wire.
};

/// Four points of the sensor's image [px, y up], as stored in the camera's factory calibration.
using FactoryPoints = std::array<std::array<int, 2>, 4>;

/// Plausible factory points: a rectangle of four fifths of the image around (`centre_x`,
/// `centre_y`) [px, y up], each corner moved by a few random pixels. How the factory finds the
/// points is unknown; in the one known real block their mean is (525, 354).
FactoryPoints factoryPoints(double centre_x, double centre_y, std::uint32_t seed);

/// The device side of the Wii Remote's HID protocol: registers, EEPROM, camera enable sequence,
/// report modes 0x30..0x37, 0x3d and the pair 0x3e/0x3f, status, acknowledgements and error codes.
/// Pure logic: no I/O, clock or thread. Only the camera, a plugged-in Nunchuk and a built-in
/// MotionPlus have registers; other addresses give error 7. Without an extension its bytes are ff.
/// Where descriptions of the remote differ, the device is strict: the camera works only with 0x13
/// and 0x1a on, both sensitivity blocks and a mode written, and register 0x30 = 8.
class Device {
 public:
  struct Options {
    std::uint8_t battery = 0xa0;  ///< Raw level; below 0x20 the status says that it is low.
    /// As in a real remote.
    FactoryPoints factory_points{{{136, 645}, {907, 650}, {919, 63}, {140, 57}}};
    bool motion_plus = false;  ///< Built in, as in the RVL-CNT-01-TR.
    /// Slot of a new or returned light. Not set: the first free one; else a random free one with
    /// this seed. Hosts must not rely on either.
    std::optional<std::uint32_t> slot_seed;
  };

  Device();
  explicit Device(const Options& options);
  ~Device();

  /// Handles an output report of the host. @returns the answers in order; for a read of more than
  /// 16 bytes only the first packet, sample() returns the others. Unknown reports are ignored.
  std::vector<Bytes> handleOutput(const Bytes& report);

  /// Samples the sensors. @returns the data report of the present mode, or the next packet of a
  /// read in progress, or nothing if nothing changed and the host wants changes only.
  std::optional<Bytes> sample(const Senses& senses);

  /// Player LEDs 1..4 in bits 0..3, as last set by the host.
  std::uint8_t leds() const;

  /// Whether the motor runs; every output report sets it.
  bool rumble() const;

  /// Sets the raw level of the batteries.
  void setBattery(std::uint8_t level);

  /// Plugs a Nunchuk in, or unplugs it. @returns the status report for the host, or nothing without
  /// a change. Data reports then stop until the host sets a mode.
  std::optional<Bytes> setNunchuk(bool plugged);

  /// Resets the volatile state, as switching off and on.
  void powerCycle();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace wiimote_tracker::virtual_wiimote
