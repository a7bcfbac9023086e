// The virtual remote's reports, compared with the same second description of the wire.
#include "wire_layouts.h"

#include "wiimote_tracker_driver/virtual_wiimote/device.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <tuple>
#include <vector>

namespace wiimote_tracker::virtual_wiimote {
namespace {

/// A host's writes to see in that format, in bytes by hand: the console's fifth level.
void startCamera(Device& device, wire::Format format, int report) {
  const Bytes outputs[] = {
      {0x13, 0x04},
      {0x1a, 0x04},
      {0x16, 0x04, 0xb0, 0x00, 0x30, 1, 0x01},
      {0x16, 0x04, 0xb0, 0x00, 0x00, 9, 0x07, 0, 0, 0x71, 0x01, 0, 0x72, 0, 0x20},
      {0x16, 0x04, 0xb0, 0x00, 0x1a, 2, 0x1f, 0x03},
      {0x16, 0x04, 0xb0, 0x00, 0x33, 1, static_cast<std::uint8_t>(format)},
      {0x16, 0x04, 0xb0, 0x00, 0x30, 1, 0x08},
      {0x12, 0x04, static_cast<std::uint8_t>(report)}};
  for (const Bytes& output : outputs)
    device.handleOutput(output);
}

Light light(unsigned x, unsigned y, unsigned size) {
  Light result;
  result.x = x;
  result.y = y;
  result.size = size;
  return result;
}

using Seen = std::multiset<std::tuple<unsigned, unsigned, unsigned>>;  // x, y, size

/// Adds the spots of a report by the tables.
void read(const wire::DataReport& layout, const Bytes& report, Seen& seen) {
  for (std::size_t slot = 0; slot < layout.slots; ++slot) {
    const wire::Spot place = wire::spot(layout.format, slot, layout.infrared);
    const unsigned x = place.x.read(report.data());
    const unsigned y = place.y.read(report.data());
    seen.emplace(x, y, place.size ? place.size->read(report.data()) : 0);
    if (layout.format != wire::Format::kFull)
      continue;
    // The box contains the spot, and lies on the sensor.
    EXPECT_LE(place.x_min->read(report.data()), x / 8);
    EXPECT_GE(place.x_max->read(report.data()), x / 8);
    EXPECT_LE(place.y_min->read(report.data()), y / 8);
    EXPECT_GE(place.y_max->read(report.data()), y / 8);
    EXPECT_LT(place.x_max->read(report.data()), 128u);
    EXPECT_LT(place.y_max->read(report.data()), 96u);
    EXPECT_GT(place.intensity->read(report.data()), 0u);
  }
}

const wire::DataReport& layoutOf(int id) {
  return *std::find_if(wire::kDataReports.begin(), wire::kDataReports.end(),
                       [id](const wire::DataReport& layout) { return layout.id == id; });
}

/// Samples until the next report is the first half of a pair.
void finishPair(Device& device) {
  for (auto report = device.sample(Senses()); report && (*report)[0] != 0x3f;)
    report = device.sample(Senses());
}

/// Four lights at all places: too far apart to merge, and no two equal in any byte. Each takes
/// every `step`-th place of a row; with 2 they cover all places together.
void expectEveryPlace(int id, unsigned step) {
  const wire::DataReport& layout = layoutOf(id);
  const bool sized = layout.format != wire::Format::kBasic;
  Device device;
  startCamera(device, layout.format, id);
  if (layout.slots == 2)
    finishPair(device);
  Senses senses;
  std::uint64_t wrong = 0;
  unsigned turn = 0;
  for (unsigned y = 0; y < 768; ++y) {
    for (unsigned x = y % step; x < 1024; x += step, ++turn) {
      senses.lights.clear();
      Seen expected;
      for (unsigned i = 0; i < 4; ++i) {
        const unsigned size = (turn + 4 * i) % 15 + 1;
        const unsigned place_x = (x + i % 2 * 475) % 1024;
        const unsigned place_y = (y + i / 2 * 355) % 768;
        senses.lights.push_back(light(place_x, place_y, size));
        expected.emplace(place_x, place_y, sized ? size : 0);
      }
      Seen seen;
      for (std::size_t spots = 0; spots < 4; spots += layout.slots) {
        const auto report = device.sample(senses);
        ASSERT_TRUE(report);
        ASSERT_EQ(report->size(), layout.size);
        ASSERT_EQ((*report)[0], id + static_cast<int>(spots / 2 % 2));
        read(layout, *report, seen);
      }
      wrong += seen != expected;
    }
  }
  EXPECT_EQ(wrong, 0u) << "report 0x" << std::hex << id;
}

TEST(VirtualWireLayouts, ExtendedSpotsOfEveryPlace) {
  expectEveryPlace(0x33, 2 * wire::kStep);
}

TEST(VirtualWireLayouts, BasicSpots) {
  expectEveryPlace(0x36, 11 * wire::kStep);
  expectEveryPlace(0x37, 11 * wire::kStep);
}

TEST(VirtualWireLayouts, FullSpotsInBothHalves) {
  expectEveryPlace(0x3e, 11 * wire::kStep);
}

TEST(VirtualWireLayouts, EveryReportHasItsLength) {
  for (const wire::DataReport& layout : wire::kDataReports) {
    Device device;
    device.handleOutput({0x12, 0x04, static_cast<std::uint8_t>(layout.id)});
    const auto report = device.sample(Senses());
    ASSERT_TRUE(report) << std::hex << layout.id;
    EXPECT_EQ(report->size(), layout.size) << std::hex << layout.id;
  }
}

TEST(VirtualWireLayouts, AccelerationIsTheSameInEveryReport) {
  Senses senses;
  std::set<unsigned> seen_x;
  for (int step = -500; step <= 500; ++step) {
    senses.acceleration = {0.01 * step, -0.007 * step, 0.003 * step};
    std::array<unsigned, 3> reference{};
    for (const wire::DataReport& layout : wire::kDataReports) {
      if (!layout.acceleration)
        continue;
      Device device;
      device.handleOutput({0x12, 0x04, static_cast<std::uint8_t>(layout.id)});
      const auto report = device.sample(senses);
      ASSERT_TRUE(report);
      std::array<unsigned, 3> value{};
      for (std::size_t axis = 0; axis < 3; ++axis)
        value[axis] = wire::kAcceleration[axis].read(report->data()) << (axis == 0 ? 0 : 1);
      if (layout.id == 0x31)
        reference = value;
      EXPECT_EQ(value, reference) << std::hex << layout.id;
    }
    seen_x.insert(reference[0]);

    Device device;
    device.handleOutput({0x12, 0x04, 0x3e});
    finishPair(device);
    const auto first = device.sample(senses);
    const auto second = device.sample(senses);
    ASSERT_TRUE(first && second);
    ASSERT_EQ((*first)[0], 0x3e);
    ASSERT_EQ((*second)[0], 0x3f);
    EXPECT_EQ(wire::kInterleavedWhole.read(first->data()), reference[0] / 4);
    EXPECT_EQ(wire::kInterleavedWhole.read(second->data()), reference[1] / 4);
    EXPECT_EQ(
        wire::kInterleavedZ.read(first->data()) << 4 | wire::kInterleavedZ.read(second->data()),
        reference[2] / 4);
  }
  // 10 g in steps of about one unit of the converter: nearly its whole range.
  EXPECT_GT(seen_x.size(), 900u);
}

TEST(VirtualWireLayouts, EveryButtonAndNothingElse) {
  Device device;
  device.handleOutput({0x12, 0x04, 0x30});
  Senses senses;
  std::uint64_t wrong = 0;
  for (unsigned state = 0; state < 0x10000; ++state) {
    senses.buttons = static_cast<std::uint16_t>(state);
    const Bytes pressed{0x30, static_cast<std::uint8_t>(state >> 8),
                        static_cast<std::uint8_t>(state)};
    Bytes expected{0x30, 0, 0};
    static const std::vector<BitField> places = [] {
      std::vector<BitField> result;
      for (const wire::Button& button : wire::kButtons)
        result.emplace_back(button.place);
      return result;
    }();
    for (const BitField& place : places)
      place.write(expected.data(), place.read(pressed.data()));
    wrong += device.sample(senses) != expected;
  }
  EXPECT_EQ(wrong, 0u);
}

TEST(VirtualWireLayouts, EveryStatus) {
  for (unsigned battery = 0; battery < 256; ++battery) {
    Device::Options options;
    options.battery = static_cast<std::uint8_t>(battery);
    Device device(options);
    for (unsigned state = 0; state < 64; ++state) {
      Bytes leds{0x11, 0};
      wire::output::kLeds.write(leds.data(), state % 16);
      device.handleOutput(leds);
      device.handleOutput({0x13, static_cast<std::uint8_t>(state & 16 ? 4 : 0)});
      device.handleOutput({0x14, static_cast<std::uint8_t>(state & 32 ? 4 : 0)});
      const std::vector<Bytes> answers = device.handleOutput({0x15, 0});
      ASSERT_EQ(answers.size(), 1u);
      ASSERT_EQ(answers[0].size(), wire::status::kSize);
      const std::uint8_t* status = answers[0].data();
      EXPECT_EQ(wire::status::kLeds.read(status), state % 16);
      EXPECT_EQ(wire::status::kCamera.read(status), state / 16 % 2);
      EXPECT_EQ(wire::status::kSpeaker.read(status), state / 32);
      EXPECT_EQ(wire::status::kExtension.read(status), 0u);
      EXPECT_EQ(wire::status::kBatteryLow.read(status), battery < 0x20 ? 1u : 0u);
      EXPECT_EQ(wire::status::kBattery.read(status), battery);
    }
  }
}

TEST(VirtualWireLayouts, WritesAreReadBackAtEveryPlaceAndInEverySize) {
  Device device;
  for (unsigned address = 0; address < 0x1700; address += 7) {
    const unsigned size = std::min(address % 16 + 1, 0x1700 - address);
    Bytes write(22, 0);
    write[0] = 0x16;
    wire::output::kAddress.write(write.data(), address);
    wire::output::kWriteSize.write(write.data(), size);
    for (unsigned i = 0; i < size; ++i)
      write[wire::output::kWriteData + i] = static_cast<std::uint8_t>(31 * address + 7 * i);
    const std::vector<Bytes> written = device.handleOutput(write);
    ASSERT_EQ(written.size(), 1u);
    ASSERT_EQ(written[0].size(), wire::acknowledgement::kSize);
    EXPECT_EQ(wire::acknowledgement::kReport.read(written[0].data()), 0x16u);
    EXPECT_EQ(wire::acknowledgement::kError.read(written[0].data()), 0u);

    Bytes read(7, 0);
    read[0] = 0x17;
    wire::output::kAddress.write(read.data(), address);
    wire::output::kReadSize.write(read.data(), size);
    const std::vector<Bytes> packets = device.handleOutput(read);
    ASSERT_EQ(packets.size(), 1u);
    const Bytes& packet = packets[0];
    ASSERT_EQ(packet.size(), wire::memory::kSize);
    EXPECT_EQ(wire::memory::kAddress.read(packet.data()), address);
    EXPECT_EQ(wire::memory::kError.read(packet.data()), 0u);
    EXPECT_EQ(wire::memory::kSizeLessOne.read(packet.data()), size - 1);
    EXPECT_TRUE(std::equal(packet.begin() + wire::memory::kData,
                           packet.begin() + wire::memory::kData + size,
                           write.begin() + wire::output::kWriteData));
  }
}

TEST(VirtualWireLayouts, FactoryBlocksHaveTheirChecksums) {
  Device device;
  for (const auto& [address, size] :
       {std::pair<unsigned, unsigned>{0x00, 11}, {0x0b, 11}, {0x16, 10}, {0x20, 10}}) {
    Bytes read(7, 0);
    read[0] = 0x17;
    wire::output::kAddress.write(read.data(), address);
    wire::output::kReadSize.write(read.data(), size);
    const std::vector<Bytes> packets = device.handleOutput(read);
    ASSERT_EQ(packets.size(), 1u);
    const std::uint8_t* block = packets[0].data() + wire::memory::kData;
    EXPECT_EQ(block[size - 1], wire::checksum(block, size - 1)) << std::hex << address;
  }
}

}  // namespace
}  // namespace wiimote_tracker::virtual_wiimote
