// The driver's decoders and encoders, compared with a second description of the wire: all values of
// each field, with random data around it.
// Here the data reports, in test_wire_layouts_others.cpp all others.
#include "noise.h"
#include "wire_layouts.h"

#include "wiimote_tracker_driver/protocol/input_reports.h"

#include <gtest/gtest.h>

#include <vector>

namespace wiimote_tracker {
namespace {

using protocol::IrSpot;
using protocol::Report;

/// The spot by the tables. A slot without a light has a y beyond the sensor, or zeros.
bool same(const IrSpot& found, unsigned x, unsigned y, unsigned size) {
  const bool seen = y < 768 && (x != 0 || y != 0 || size != 0);
  if (!seen)
    return !found.seen && found.x == 0 && found.y == 0 && found.size == 0;
  return found.seen && found.x == static_cast<int>(x) && found.y == static_cast<int>(y) &&
         found.size == static_cast<int>(size);
}

// ---- Spots. In all tests each slot goes through all values; neighbouring slots differ at any
// time.

TEST(WireLayouts, ExtendedSpotsOfEveryPlaceAndSizeInEverySlot) {
  Noise noise;
  Report report = noise.report(0x33, 18);
  std::vector<wire::Spot> spots;
  for (std::size_t slot = 0; slot < 4; ++slot)
    spots.push_back(wire::spot(wire::Format::kExtended, slot, 6));
  const auto y_of = [](unsigned y, unsigned slot) { return (y + 256 * slot) % 1024; };
  const auto size_of = [](unsigned size, unsigned slot) { return (size + 5 * slot) % 16; };
  const auto x_of = [](unsigned x, unsigned slot) { return (x + 341 * slot) % 1024; };
  std::uint64_t wrong = 0;
  for (unsigned y = 0; y < 1024; ++y) {
    for (unsigned size = 0; size < 16; ++size) {
      for (unsigned slot = 0; slot < 4; ++slot) {
        spots[slot].y.write(report.bytes.data(), y_of(y, slot));
        spots[slot].size->write(report.bytes.data(), size_of(size, slot));
      }
      for (unsigned x = y % wire::kStep; x < 1024; x += wire::kStep) {
        for (unsigned slot = 0; slot < 4; ++slot)
          spots[slot].x.write(report.bytes.data(), x_of(x, slot));
        const auto data = protocol::decodeDataReport(report);
        ASSERT_TRUE(data);
        for (unsigned slot = 0; slot < 4; ++slot)
          wrong += !same(data->spots[slot], x_of(x, slot), y_of(y, slot), size_of(size, slot));
      }
    }
  }
  EXPECT_EQ(wrong, 0u);
}

TEST(WireLayouts, BasicSpotsOfEveryPlaceInEverySlot) {
  for (const int id : {0x36, 0x37}) {
    Noise noise;
    Report report = noise.report(id, 22);
    std::vector<wire::Spot> spots;
    for (std::size_t slot = 0; slot < 4; ++slot)
      spots.push_back(wire::spot(wire::Format::kBasic, slot, id == 0x36 ? 3 : 6));
    const auto y_of = [](unsigned y, unsigned slot) { return (y + 257 * slot) % 1024; };
    const auto x_of = [](unsigned x, unsigned slot) { return (x + 341 * slot) % 1024; };
    std::uint64_t wrong = 0;
    for (unsigned y = 0; y < 1024; ++y) {
      for (unsigned x = y % wire::kStep; x < 1024; x += wire::kStep) {
        for (unsigned slot = 0; slot < 4; ++slot) {
          spots[slot].x.write(report.bytes.data(), x_of(x, slot));
          spots[slot].y.write(report.bytes.data(), y_of(y, slot));
        }
        const auto data = protocol::decodeDataReport(report);
        ASSERT_TRUE(data);
        for (unsigned slot = 0; slot < 4; ++slot)
          wrong += !same(data->spots[slot], x_of(x, slot), y_of(y, slot), 0);
      }
    }
    EXPECT_EQ(wrong, 0u) << "report 0x" << std::hex << id;
  }
}

/// The halves of an interleaved report, which carry four spots in the full format.
struct Halves {
  Report first;
  Report second;
};

Halves halves(Noise& noise) {
  return {noise.report(0x3e, 22), noise.report(0x3f, 22)};
}

/// The half that holds spot `slot`, and the spot's place in it.
std::uint8_t* halfOf(Halves& halves, std::size_t slot) {
  return slot < 2 ? halves.first.bytes.data() : halves.second.bytes.data();
}
wire::Spot fullSpot(std::size_t slot) {
  return wire::spot(wire::Format::kFull, slot % 2, 4);
}

bool sameFull(const IrSpot& found, const wire::Spot& places, const std::uint8_t* bytes) {
  if (!same(found, places.x.read(bytes), places.y.read(bytes), places.size->read(bytes)))
    return false;
  const std::array<const BitField*, 4> box{
      {&*places.x_min, &*places.y_min, &*places.x_max, &*places.y_max}};
  bool good = found.intensity == (found.seen ? int(places.intensity->read(bytes)) : 0);
  for (std::size_t i = 0; i < 4; ++i)
    good = good && found.box[i] == (found.seen ? int(box[i]->read(bytes)) : 0);
  return good;
}

TEST(WireLayouts, FullSpotsOfEveryPlaceInEverySlot) {
  Noise noise;
  Halves report = halves(noise);
  std::vector<wire::Spot> spots;
  for (std::size_t slot = 0; slot < 4; ++slot)
    spots.push_back(fullSpot(slot));
  std::uint64_t wrong = 0;
  for (unsigned y = 0; y < 1024; ++y) {
    for (std::size_t slot = 0; slot < 4; ++slot)
      spots[slot].y.write(halfOf(report, slot), (y + 257 * unsigned(slot)) % 1024);
    for (unsigned x = y % wire::kStep; x < 1024; x += wire::kStep) {
      for (std::size_t slot = 0; slot < 4; ++slot)
        spots[slot].x.write(halfOf(report, slot), (x + 341 * unsigned(slot)) % 1024);
      const auto data = protocol::decodeInterleaved(report.first, report.second);
      ASSERT_TRUE(data);
      for (std::size_t slot = 0; slot < 4; ++slot)
        wrong +=
            !same(data->spots[slot], (x + 341 * unsigned(slot)) % 1024,
                  (y + 257 * unsigned(slot)) % 1024, spots[slot].size->read(halfOf(report, slot)));
    }
  }
  EXPECT_EQ(wrong, 0u);
}

TEST(WireLayouts, EveryValueOfEveryFieldOfAFullSpot) {
  Noise noise;
  for (std::size_t slot = 0; slot < 4; ++slot) {
    const wire::Spot places = fullSpot(slot);
    const std::array<const BitField*, 8> fields{{&places.x, &places.y, &*places.size,
                                                 &*places.x_min, &*places.y_min, &*places.x_max,
                                                 &*places.y_max, &*places.intensity}};
    for (std::size_t field = 0; field < fields.size(); ++field) {
      std::uint64_t wrong = 0;
      for (unsigned value = 0; value < fields[field]->values(); ++value) {
        Halves report = halves(noise);
        fields[field]->write(halfOf(report, slot), value);
        const auto data = protocol::decodeInterleaved(report.first, report.second);
        ASSERT_TRUE(data);
        for (std::size_t other = 0; other < 4; ++other)
          wrong += !sameFull(data->spots[other], fullSpot(other), halfOf(report, other));
      }
      EXPECT_EQ(wrong, 0u) << "slot " << slot << ", field " << field;
    }
  }
}

// ---- Other data in the same report.

TEST(WireLayouts, DataReportsHaveTheirPartsOnly) {
  Noise noise;
  for (const wire::DataReport& layout : wire::kDataReports) {
    if (wire::isHalf(layout))
      continue;
    const auto data = protocol::decodeDataReport(noise.report(layout.id, layout.size));
    ASSERT_TRUE(data) << std::hex << layout.id;
    EXPECT_EQ(data->id, layout.id);
    EXPECT_EQ(data->acceleration.has_value(), layout.acceleration) << std::hex << layout.id;
    EXPECT_EQ(static_cast<int>(data->ir_format), static_cast<int>(layout.format));
  }
}

TEST(WireLayouts, EveryAccelerationInEveryReport) {
  Noise noise;
  for (const wire::DataReport& layout : wire::kDataReports) {
    if (!layout.acceleration)
      continue;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::uint64_t wrong = 0;
      for (unsigned value = 0; value < wire::kAcceleration[axis].values(); ++value) {
        Report report = noise.report(layout.id, layout.size);
        wire::kAcceleration[axis].write(report.bytes.data(), value);
        const auto data = protocol::decodeDataReport(report);
        for (std::size_t i = 0; i < 3; ++i) {
          // y and z lack their lowest bit.
          const unsigned expected = wire::kAcceleration[i].read(report.bytes.data())
                                    << (i == 0 ? 0 : 1);
          wrong += !data || !data->acceleration || (*data->acceleration)[i] != int(expected);
        }
      }
      EXPECT_EQ(wrong, 0u) << "report 0x" << std::hex << layout.id << ", axis " << axis;
    }
  }
}

TEST(WireLayouts, EveryInterleavedAcceleration) {
  Noise noise;
  std::uint64_t wrong = 0;
  for (unsigned value = 0; value < 256; ++value) {
    for (unsigned axis = 0; axis < 3; ++axis) {
      Halves report = halves(noise);
      std::uint8_t* first = report.first.bytes.data();
      std::uint8_t* second = report.second.bytes.data();
      if (axis < 2) {
        wire::kInterleavedWhole.write(axis == 0 ? first : second, value);
      } else {
        wire::kInterleavedZ.write(first, value >> 4);
        wire::kInterleavedZ.write(second, value & 15);
      }
      const unsigned x = wire::kInterleavedWhole.read(first);
      const unsigned y = wire::kInterleavedWhole.read(second);
      const unsigned z = wire::kInterleavedZ.read(first) << 4 | wire::kInterleavedZ.read(second);
      const auto data = protocol::decodeInterleaved(report.first, report.second);
      // The two lowest of ten bits are missing.
      wrong +=
          !data || data->acceleration != std::array<int, 3>{{int(4 * x), int(4 * y), int(4 * z)}};
    }
  }
  EXPECT_EQ(wrong, 0u);
}

TEST(WireLayouts, EveryStateOfTheButtonBytesInEveryReport) {
  std::vector<std::pair<int, std::size_t>> reports{{0x20, wire::status::kSize},
                                                   {0x21, wire::memory::kSize},
                                                   {0x22, wire::acknowledgement::kSize}};
  for (const wire::DataReport& layout : wire::kDataReports)
    reports.emplace_back(layout.id, layout.size);
  std::vector<BitField> places;
  for (const wire::Button& button : wire::kButtons)
    places.emplace_back(button.place);
  Noise noise;
  for (const auto& [id, size] : reports) {
    std::uint64_t wrong = 0;
    Report report = noise.report(id, size);
    for (unsigned state = 0; state < 0x10000; ++state) {
      report.bytes[1] = static_cast<std::uint8_t>(state >> 8);
      report.bytes[2] = static_cast<std::uint8_t>(state);
      std::uint8_t buttons[3] = {0, 0, 0};
      for (const BitField& place : places)
        place.write(buttons, place.read(report.bytes.data()));
      wrong += protocol::decodeButtons(report) != (buttons[1] << 8 | buttons[2]);
    }
    EXPECT_EQ(wrong, 0u) << "report 0x" << std::hex << id;
  }
}

}  // namespace
}  // namespace wiimote_tracker
