#include "wiimote_tracker_driver/protocol/input_reports.h"

#include "ir_position.h"

#include <algorithm>
#include <map>

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

// A slot without a light has ff, or zeros before its first light. Only y is decisive: its largest
// value is 767, while a valid x may have the low byte ff.
IrSpot spot(const std::array<int, 2>& position, int size) {
  IrSpot result;
  result.seen = position[1] < kSensorHeight && (position[0] != 0 || position[1] != 0 || size != 0);
  if (result.seen) {
    result.x = position[0];
    result.y = position[1];
    result.size = size;
  }
  return result;
}

// Whether these bytes can be a slot without a light.
bool isEmptySlot(const std::uint8_t* in, std::size_t size) {
  return (in[0] == 0x00 || in[0] == 0xff) &&
         std::all_of(in, in + size, [&](std::uint8_t byte) { return byte == in[0]; });
}

void decodeBasic(const std::uint8_t* in, DataReport& data) {
  for (std::size_t i = 0; i < 4; i += 2, in += 5) {
    const std::array<int, 2> first = firstOfPair(in);
    const std::array<int, 2> second = secondOfPair(in);
    data.spots[i] = spot(first, 0);
    data.spots[i + 1] = spot(second, 0);
    for (const auto& position : {first, second}) {
      if (position[1] >= kSensorHeight && (position[0] != 0x3ff || position[1] != 0x3ff))
        data.plausible = false;
    }
  }
}

void decodeExtended(const std::uint8_t* in, DataReport& data) {
  for (IrSpot& out : data.spots) {
    out = spot(firstOfPair(in), in[2] & 0x0f);
    if (!out.seen && !isEmptySlot(in, 3))
      data.plausible = false;
    in += 3;
  }
}

// Half of the slots, at `first`.
void decodeFull(const std::uint8_t* in, std::size_t first, DataReport& data) {
  for (std::size_t i = first; i < first + 2; ++i, in += 9) {
    IrSpot& out = data.spots[i];
    out = spot(firstOfPair(in), in[2] & 0x0f);
    if (out.seen) {
      for (std::size_t j = 0; j < 4; ++j) {
        out.box[j] = in[3 + j] & 0x7f;
        if (in[3 + j] > 0x7f)
          data.plausible = false;
      }
      out.intensity = in[8];
    } else if (!isEmptySlot(in, 9)) {
      data.plausible = false;
    }
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

const char* errorName(std::uint8_t error) {
  static const std::map<std::uint8_t, const char*> kNames{
      {0, "none"},
      {2, "sent on the wrong Bluetooth channel"},
      {4, "busy with another read"},
      {5, "address out of range"},
      {6, "no such address space"},
      {7, "no answer at this address"},
      {8, "address out of range"},
  };
  const auto known = kNames.find(error);
  return known == kNames.end() ? "unknown" : known->second;
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
    decodeBasic(&bytes[layout.ir], data);
  else if (layout.ir_format == IrFormat::kExtended)
    decodeExtended(&bytes[layout.ir], data);
  return data;
}

std::optional<DataReport> decodeInterleaved(const Report& first, const Report& second) {
  if (!is(first, kFirstHalfId, 22) || !is(second, kSecondHalfId, 22))
    return std::nullopt;
  const auto& a = first.bytes;
  const auto& b = second.bytes;
  DataReport data;
  data.id = kFirstHalfId;
  data.buttons = decodeButtons(second);
  // x, y and z have eight bits each; those of z are scattered over the unused ones of the buttons.
  const int z = (a[2] & 0x60) << 1 | (a[1] & 0x60) >> 1 | (b[2] & 0x60) >> 3 | (b[1] & 0x60) >> 5;
  data.acceleration = {a[3] << 2, b[3] << 2, z << 2};
  data.ir_format = IrFormat::kFull;
  decodeFull(&a[4], 0, data);
  decodeFull(&b[4], 2, data);
  return data;
}

}  // namespace wiimote_tracker::protocol
