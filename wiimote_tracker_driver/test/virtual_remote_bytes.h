#pragma once

#include "wiimote_tracker_driver/virtual_wiimote/device.h"

#include <cstdint>
#include <utility>
#include <vector>

namespace wiimote_tracker::virtual_wiimote {

using Answers = std::vector<Bytes>;

/// A register or EEPROM write as it crosses the wire, 22 bytes.
inline Bytes write(std::uint8_t flags, const Bytes& address, const Bytes& payload) {
  Bytes report{0x16, flags};
  report.insert(report.end(), address.begin(), address.end());
  report.push_back(static_cast<std::uint8_t>(payload.size()));
  report.insert(report.end(), payload.begin(), payload.end());
  report.resize(22, 0);
  return report;
}

const Bytes kClockOn{0x13, 0x06};
const Bytes kLogicOn{0x1a, 0x06};
const Bytes kBegin = write(0x04, {0xb0, 0x00, 0x30}, {0x01});
const Bytes kBlock1 =
    write(0x04, {0xb0, 0x00, 0x00}, {0x02, 0, 0, 0x71, 0x01, 0x00, 0xaa, 0x00, 0x64});
const Bytes kBlock2 = write(0x04, {0xb0, 0x00, 0x1a}, {0x63, 0x03});
const Bytes kBasic = write(0x04, {0xb0, 0x00, 0x33}, {0x01});
const Bytes kExtended = write(0x04, {0xb0, 0x00, 0x33}, {0x03});
const Bytes kFull = write(0x04, {0xb0, 0x00, 0x33}, {0x05});
const Bytes kRun = write(0x04, {0xb0, 0x00, 0x30}, {0x08});
const Bytes kReport33{0x12, 0x04, 0x33};

/// From switching on to extended infrared at the console's middle level.
inline std::vector<Bytes> handshake() {
  return {kClockOn, kLogicOn, kBegin, kBlock1, kBlock2, kExtended, kRun, kReport33};
}

inline Senses lights(std::vector<Light> lights) {
  Senses senses;
  senses.lights = std::move(lights);
  return senses;
}

}  // namespace wiimote_tracker::virtual_wiimote
