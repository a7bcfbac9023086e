#include "data_report.h"

#include <cstddef>
#include <map>

namespace wiimote_tracker::virtual_wiimote {
namespace {

constexpr std::uint8_t kExtensionOnly = 0x3d;
constexpr std::uint8_t kButtonMaskHigh = 0x1f;
constexpr std::uint8_t kButtonMaskLow = 0x9f;

/// Contents of a data report after the buttons, in this order, each from its first byte.
struct Layout {
  bool acceleration;
  std::ptrdiff_t infrared;
  std::ptrdiff_t extension;
};

const std::map<std::uint8_t, Layout> kLayouts{
    {0x30, {false, 0, 0}},  {0x31, {true, 0, 0}},   {0x32, {false, 0, 8}},
    {0x33, {true, 12, 0}},  {0x34, {false, 0, 19}}, {0x35, {true, 0, 16}},
    {0x36, {false, 10, 9}}, {0x37, {true, 10, 6}},  {kExtensionOnly, {false, 0, 21}},
};

/// Sets bits 5 and 6 of a button byte, which carry bits of the acceleration.
void addBits(std::uint8_t& buttons, int bits) {
  buttons = byte(buttons | (bits & 3) << 5);
}

void appendAcceleration(const std::array<int, 3>& raw, Bytes& report) {
  for (const int value : raw)
    report.push_back(byte(value >> 2));
  addBits(report[1], raw[0]);
  // y and z have only nine bits.
  addBits(report[2], (raw[1] >> 1 & 1) | (raw[2] & 2));
}

/// One of two interleaved reports: half of the infrared data, x or y, half of z; 8 bits each.
Bytes half(bool first, const Sample& sample) {
  Bytes report = beginReport(first ? kFirstHalf : kSecondHalf, sample.buttons);
  const int z = sample.acceleration[2] >> 2;
  addBits(report[1], first ? z >> 4 : z);
  addBits(report[2], first ? z >> 6 : z >> 2);
  report.push_back(byte(sample.acceleration[first ? 0 : 1] >> 2));
  const auto begin = sample.infrared.begin() + (first ? 0 : 18);
  report.insert(report.end(), begin, begin + 18);
  return report;
}

}  // namespace

Bytes beginReport(std::uint8_t id, std::uint16_t buttons) {
  if (id == kExtensionOnly)
    return {id};
  return {id, byte(buttons >> 8 & kButtonMaskHigh), byte(buttons & kButtonMaskLow)};
}

bool isDataReport(std::uint8_t id) {
  return id == kFirstHalf || id == kSecondHalf || kLayouts.count(id) > 0;
}

Bytes dataReport(std::uint8_t id, const Sample& sample) {
  if (id == kFirstHalf || id == kSecondHalf)
    return half(id == kFirstHalf, sample);
  const Layout& layout = kLayouts.at(id);
  Bytes report = beginReport(id, sample.buttons);
  if (layout.acceleration)
    appendAcceleration(sample.acceleration, report);
  const auto infrared = sample.infrared.begin();
  report.insert(report.end(), infrared, infrared + layout.infrared);
  const auto extension = sample.extension.begin();
  report.insert(report.end(), extension, extension + layout.extension);
  return report;
}

}  // namespace wiimote_tracker::virtual_wiimote
