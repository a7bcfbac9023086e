#pragma once

#include "bit_field.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

/// Positions of all data in the Wii Remote's reports: tables of bit places, written from
/// descriptions of the device, independent of the driver and the virtual remote.
namespace wiimote_tracker::wire {

/// Exhaustive tests take every value; under the address sanitizer, which is ten times as slow and
/// checks other things, only every eighth.
#ifdef __SANITIZE_ADDRESS__
constexpr unsigned kStep = 8;
#else
constexpr unsigned kStep = 1;
#endif

/// The infrared formats by the number that the camera's mode register takes.
enum class Format { kNone = 0, kBasic = 1, kExtended = 3, kFull = 5 };

/// The parts of a report with sensor data. Byte 0 is the report id, bytes 1 and 2 are the buttons.
struct DataReport {
  int id;
  std::size_t size;
  bool acceleration;
  Format format;
  std::size_t infrared;  ///< First byte.
  std::size_t slots;     ///< Spots in this report.
};

/// Whether it is one of the two reports of which full spots need both.
inline bool isHalf(const DataReport& layout) {
  return layout.format == Format::kFull;
}

const std::array<DataReport, 10> kDataReports{{{0x30, 3, false, Format::kNone, 0, 0},
                                               {0x31, 6, true, Format::kNone, 0, 0},
                                               {0x32, 11, false, Format::kNone, 0, 0},
                                               {0x33, 18, true, Format::kExtended, 6, 4},
                                               {0x34, 22, false, Format::kNone, 0, 0},
                                               {0x35, 22, true, Format::kNone, 0, 0},
                                               {0x36, 22, false, Format::kBasic, 3, 4},
                                               {0x37, 22, true, Format::kBasic, 6, 4},
                                               {0x3e, 22, false, Format::kFull, 4, 2},
                                               {0x3f, 22, false, Format::kFull, 4, 2}}};

/// The buttons; all other bits of bytes 1 and 2 have other meanings or none.
struct Button {
  const char* name;
  const char* place;
};
const std::array<Button, 11> kButtons{{{"left", "1.0"},
                                       {"right", "1.1"},
                                       {"down", "1.2"},
                                       {"up", "1.3"},
                                       {"plus", "1.4"},
                                       {"two", "2.0"},
                                       {"one", "2.1"},
                                       {"B", "2.2"},
                                       {"A", "2.3"},
                                       {"minus", "2.4"},
                                       {"home", "2.7"}}};

/// x, y, z of the accelerometer in reports 0x31, 33, 35, 37: ten bits of x, the upper nine of y, z.
const std::array<BitField, 3> kAcceleration{
    {BitField("3.7-0 1.6-5"), BitField("4.7-0 2.5"), BitField("5.7-0 2.6")}};

/// The interleaved pair carries the upper eight bits: x whole in 0x3e, y whole in 0x3f, and z in
/// four places, two bits each, highest first: 0x3e byte 2, 0x3e byte 1, 0x3f byte 2, 0x3f byte 1.
const BitField kInterleavedWhole("3.7-0");
const BitField kInterleavedZ("2.6-5 1.6-5");

/// One spot, in bytes from where its slot begins.
struct Spot {
  BitField x, y;
  std::optional<BitField> size, x_min, y_min, x_max, y_max, intensity;
};

/// Spot `slot` of the infrared data that begin at `first` byte.
inline Spot spot(Format format, std::size_t slot, std::size_t first) {
  if (format == Format::kBasic) {
    // Two spots share five bytes.
    first += slot / 2 * 5;
    if (slot % 2 == 0)
      return {
          BitField("2.5-4 0.7-0", first), BitField("2.7-6 1.7-0", first), {}, {}, {}, {}, {}, {}};
    return {BitField("2.1-0 3.7-0", first), BitField("2.3-2 4.7-0", first), {}, {}, {}, {}, {}, {}};
  }
  first += slot * (format == Format::kExtended ? 3 : 9);
  Spot result{BitField("2.5-4 0.7-0", first),
              BitField("2.7-6 1.7-0", first),
              BitField("2.3-0", first),
              {},
              {},
              {},
              {},
              {}};
  if (format == Format::kFull) {
    // The box in the sensor's own coarse pixels.
    result.x_min = BitField("3.6-0", first);
    result.y_min = BitField("4.6-0", first);
    result.x_max = BitField("5.6-0", first);
    result.y_max = BitField("6.6-0", first);
    result.intensity = BitField("8.7-0", first);
  }
  return result;
}

/// Report 0x20.
namespace status {
constexpr std::size_t kSize = 7;
const BitField kLeds("3.7-4");
const BitField kCamera("3.3");
const BitField kSpeaker("3.2");
const BitField kExtension("3.1");
const BitField kBatteryLow("3.0");
const BitField kBattery("6.7-0");
}  // namespace status

/// Report 0x21: data from byte 6 on.
namespace memory {
constexpr std::size_t kSize = 22;
const BitField kSizeLessOne("3.7-4");
const BitField kError("3.3-0");
const BitField kAddress("4.7-0 5.7-0");
constexpr std::size_t kData = 6;
}  // namespace memory

/// Report 0x22.
namespace acknowledgement {
constexpr std::size_t kSize = 5;
const BitField kReport("3.7-0");
const BitField kError("4.7-0");
}  // namespace acknowledgement

/// Output reports.
namespace output {
const BitField kRumble("1.0");
const BitField kAcknowledge("1.1");
const BitField kOn(
    "1.2");  ///< Of 0x12: continuous; of 0x13 and 0x1a: enabled; 0x16, 17: registers.
const BitField kLeds("1.7-4");
const BitField kMode("2.7-0");
const BitField kAddress("2.7-0 3.7-0 4.7-0");
const BitField kReadSize("5.7-0 6.7-0");
const BitField kWriteSize("5.7-0");
constexpr std::size_t kWriteData = 6;
}  // namespace output

/// The factory's accelerometer calibration: x, y, z at 0 g, then at 1 g, ten bits each; the last of
/// its ten bytes is a checksum.
const std::array<BitField, 6> kAccelerometerBlock{
    {BitField("0.7-0 3.5-4"), BitField("1.7-0 3.3-2"), BitField("2.7-0 3.1-0"),
     BitField("4.7-0 7.5-4"), BitField("5.7-0 7.3-2"), BitField("6.7-0 7.1-0")}};

/// The factory's calibration of the infrared camera is ten bytes of infrared data in the basic
/// format, four points, and a checksum.
constexpr std::size_t kIrCalibrationPoints = 10;

/// Both factory blocks end with the sum of the bytes before it and 0x55.
inline std::uint8_t checksum(const std::uint8_t* bytes, std::size_t count) {
  unsigned sum = 0x55;
  for (std::size_t i = 0; i < count; ++i)
    sum += bytes[i];
  return static_cast<std::uint8_t>(sum % 256);
}

}  // namespace wiimote_tracker::wire
