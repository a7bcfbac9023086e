#include "wiimote_tracker_driver/protocol/input_reports.h"

#include <algorithm>

namespace wiimote_tracker::protocol {
namespace {

/// Where the parts of a data report begin; 0: the report has no such part.
struct Layout {
  std::size_t size;
  std::size_t acceleration;
  std::size_t ir;
  IrFormat ir_format;
};

// Indexed by report id - 0x30.
constexpr std::array<Layout, 8> kLayouts{{{3, 0, 0, IrFormat::kNone},
                                          {6, 3, 0, IrFormat::kNone},
                                          {11, 0, 0, IrFormat::kNone},
                                          {18, 3, 6, IrFormat::kExtended},
                                          {22, 0, 0, IrFormat::kNone},
                                          {22, 3, 0, IrFormat::kNone},
                                          {22, 0, 3, IrFormat::kBasic},
                                          {22, 3, 6, IrFormat::kBasic}}};

bool is(const Report& report, std::uint8_t id, std::size_t size) {
  return report.size >= size && report.bytes[0] == id;
}

// A slot without a light reads ff, or zeros before its first light. Only y tells: its largest
// value is 767, while x may well have ff as its low byte.
IrSpot spot(int x, int y, int size) {
  IrSpot result;
  result.seen = y < kSensorHeight && (x != 0 || y != 0 || size != 0);
  if (result.seen) {
    result.x = x;
    result.y = y;
    result.size = size;
  }
  return result;
}

void decodeBasic(const std::uint8_t* in, std::array<IrSpot, 4>& spots) {
  for (std::size_t i = 0; i < 4; i += 2, in += 5) {
    const int high = in[2];
    spots[i] = spot(in[0] | (high << 4 & 0x300), in[1] | (high << 2 & 0x300), 0);
    spots[i + 1] = spot(in[3] | (high << 8 & 0x300), in[4] | (high << 6 & 0x300), 0);
  }
}

void decodeExtended(const std::uint8_t* in, std::array<IrSpot, 4>& spots) {
  for (std::size_t i = 0; i < 4; ++i, in += 3) {
    const int high = in[2];
    spots[i] = spot(in[0] | (high << 4 & 0x300), in[1] | (high << 2 & 0x300), high & 0x0f);
  }
}

}  // namespace

std::uint16_t decodeButtons(const Report& report) {
  return report.size < 3
             ? std::uint16_t{0}
             : static_cast<std::uint16_t>((report.bytes[1] << 8 | report.bytes[2]) & 0x1f9f);
}

std::optional<Status> decodeStatus(const Report& report) {
  if (!is(report, 0x20, 7))
    return std::nullopt;
  const std::uint8_t flags = report.bytes[3];
  Status status;
  status.buttons = decodeButtons(report);
  status.battery_low = (flags & 0x01) != 0;
  status.extension = (flags & 0x02) != 0;
  status.speaker = (flags & 0x04) != 0;
  status.camera = (flags & 0x08) != 0;
  status.leds = flags >> 4;
  status.battery = report.bytes[6];
  return status;
}

double batteryCharge(std::uint8_t raw) {
  return std::clamp(2.46 * raw / 255.0 - 0.013, 0.0, 1.0);
}

std::optional<MemoryPacket> decodeMemoryPacket(const Report& report) {
  if (!is(report, 0x21, 22))
    return std::nullopt;
  MemoryPacket packet;
  packet.error = report.bytes[3] & 0x0f;
  packet.size = packet.error == 0 ? (report.bytes[3] >> 4) + 1u : 0u;
  packet.address = static_cast<std::uint16_t>(report.bytes[4] << 8 | report.bytes[5]);
  std::copy_n(report.bytes.begin() + 6, packet.data.size(), packet.data.begin());
  return packet;
}

std::optional<Acknowledgement> decodeAcknowledgement(const Report& report) {
  if (!is(report, 0x22, 5))
    return std::nullopt;
  Acknowledgement acknowledgement;
  acknowledgement.report_id = report.bytes[3];
  acknowledgement.error = report.bytes[4];
  return acknowledgement;
}

std::optional<DataReport> decodeDataReport(const Report& report) {
  if (report.size == 0 || report.bytes[0] < 0x30 || report.bytes[0] > 0x37)
    return std::nullopt;
  const Layout& layout = kLayouts[report.bytes[0] - 0x30u];
  if (report.size < layout.size)
    return std::nullopt;
  const auto& bytes = report.bytes;
  DataReport data;
  data.id = bytes[0];
  data.buttons = decodeButtons(report);
  if (layout.acceleration != 0) {
    const std::uint8_t* in = &bytes[layout.acceleration];
    data.acceleration = {in[0] << 2 | (bytes[1] >> 5 & 3), in[1] << 2 | (bytes[2] >> 4 & 2),
                         in[2] << 2 | (bytes[2] >> 5 & 2)};
  }
  data.ir_format = layout.ir_format;
  if (layout.ir_format == IrFormat::kBasic)
    decodeBasic(&bytes[layout.ir], data.spots);
  else if (layout.ir_format == IrFormat::kExtended)
    decodeExtended(&bytes[layout.ir], data.spots);
  return data;
}

}  // namespace wiimote_tracker::protocol
