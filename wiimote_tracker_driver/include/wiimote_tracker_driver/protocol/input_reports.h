#pragma once

#include "wiimote_tracker_driver/protocol/report.h"

#include <array>
#include <cstdint>
#include <optional>

/// Reports of the remote (wiibrew.org/wiki/Wiimote). Each decoder returns nothing for a report of
/// another id or one that is too short; longer ones are accepted, because some stacks pad reports.
namespace wiimote_tracker::protocol {

/// Sensor size in the units of IrSpot.
constexpr int kSensorWidth = 1024;
constexpr int kSensorHeight = 768;

/// y in an image, which points down, of the sensor's y, which points up [px].
template <typename T>
constexpr T imageY(T sensor_y) {
  return kSensorHeight - 1 - sensor_y;
}

/// Buttons: first byte in bits 8..15, second in 0..7, other bits cleared.
std::uint16_t decodeButtons(const Report& report);

/// 0x20.
struct Status {
  std::uint16_t buttons = 0;
  bool battery_low = false;
  bool extension = false;  ///< Also set by an active built-in MotionPlus.
  bool speaker = false;
  bool camera = false;
  std::uint8_t leds = 0;     ///< Player LEDs 1..4 in bits 0..3.
  std::uint8_t battery = 0;  ///< Raw level.

  friend bool operator==(const Status& a, const Status& b) {
    return a.buttons == b.buttons && a.battery_low == b.battery_low && a.extension == b.extension &&
           a.speaker == b.speaker && a.camera == b.camera && a.leds == b.leds &&
           a.battery == b.battery;
  }
};
std::optional<Status> decodeStatus(const Report& report);

/// Charge [0..1] of a raw battery level: a line that Dolphin's authors fitted; 1 at about 0x69.
double batteryCharge(std::uint8_t raw);

/// 0x21: up to 16 bytes of memory.
struct MemoryPacket {
  std::uint16_t address = 0;  ///< Low 16 bits of the address of the first byte.
  std::uint8_t error = 0;     ///< 0: none; else the read has failed, and data is invalid.
  std::size_t size = 0;       ///< Valid bytes in data, 1..16; 0 on error.
  std::array<std::uint8_t, 16> data{};
};
std::optional<MemoryPacket> decodeMemoryPacket(const Report& report);

/// Meaning of an error code of a MemoryPacket or an Acknowledgement, e.g. "unknown".
const char* errorName(std::uint8_t error);

/// 0x22. It does not say which of several reports of the same id it answers.
struct Acknowledgement {
  std::uint8_t report_id = 0;  ///< Of the output report that is answered.
  std::uint8_t error = 0;      ///< 0: none.
};
std::optional<Acknowledgement> decodeAcknowledgement(const Report& report);

/// The values are those of the camera's mode register.
enum class IrFormat : std::uint8_t { kNone = 0, kBasic = 1, kExtended = 3, kFull = 5 };

/// One slot of infrared data. Sensor axes: x to the camera's right, y UP. A slot is no identity: a
/// light that was lost may come back in any other slot.
struct IrSpot {
  bool seen = false;
  int x = 0;          ///< [px] 0..1023
  int y = 0;          ///< [px] 0..767
  int size = 0;       ///< 0..15 in the extended and the full format, else 0.
  int intensity = 0;  ///< 0..255 in the full format, else 0.
  /// x_min, y_min, x_max, y_max of the light in the sensor's own cells of 8 x 8 px, 0..127; in the
  /// full format, else 0.
  std::array<int, 4> box{};
};

/// The data report without camera and accelerometer; also the mode after switching on.
constexpr std::uint8_t kButtonsReportId = 0x30;

/// Whether the id is that of a data report, of those known here or another one.
constexpr bool isDataReport(std::uint8_t id) {
  return id >= 0x30 && id <= 0x3f;
}

/// 0x30..0x37, or a pair of 0x3e and 0x3f.
struct DataReport {
  std::uint8_t id = 0;
  std::uint16_t buttons = 0;
  /// Raw x, y, z [0..1023]; y and z lack the lowest bit, in a pair all lack the lowest two.
  std::optional<std::array<int, 3>> acceleration;
  IrFormat ir_format = IrFormat::kNone;
  std::array<IrSpot, 4> spots{};
  /// False when a slot without a light has unexpected bytes: the camera is then probably in another
  /// mode than the report.
  bool plausible = true;
};
std::optional<DataReport> decodeDataReport(const Report& report);

/// The ids of the two halves of an interleaved data report, which carries the full format: four
/// spots and one acceleration, at half the rate.
constexpr std::uint8_t kFirstHalfId = 0x3e;
constexpr std::uint8_t kSecondHalfId = 0x3f;

/// Decodes a 0x3e and the 0x3f after it; id is 0x3e.
std::optional<DataReport> decodeInterleaved(const Report& first, const Report& second);

}  // namespace wiimote_tracker::protocol
