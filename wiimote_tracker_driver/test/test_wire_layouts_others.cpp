// The driver's decoders and encoders, compared with a second description of the wire: all values of
// each field, with random data around it.
// Here all but the data reports.
#include "noise.h"
#include "wire_layouts.h"

#include "protocol/calibration_blocks.h"
#include "wiimote_tracker_driver/protocol/input_reports.h"
#include "wiimote_tracker_driver/protocol/output_reports.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace wiimote_tracker {
namespace {

using protocol::Report;

// ---- The other reports of the remote.

TEST(WireLayouts, EveryStatus) {
  Noise noise;
  Report report = noise.report(0x20, wire::status::kSize);
  const std::uint8_t* bytes = report.bytes.data();
  std::uint64_t wrong = 0;
  for (unsigned flags = 0; flags < 256; ++flags) {
    for (unsigned battery = 0; battery < 256; ++battery) {
      report.bytes[3] = static_cast<std::uint8_t>(flags);
      wire::status::kBattery.write(report.bytes.data(), battery);
      const auto status = protocol::decodeStatus(report);
      wrong += !status || status->leds != wire::status::kLeds.read(bytes) ||
               status->camera != (wire::status::kCamera.read(bytes) == 1) ||
               status->speaker != (wire::status::kSpeaker.read(bytes) == 1) ||
               status->extension != (wire::status::kExtension.read(bytes) == 1) ||
               status->battery_low != (wire::status::kBatteryLow.read(bytes) == 1) ||
               status->battery != battery;
    }
  }
  EXPECT_EQ(wrong, 0u);
}

TEST(WireLayouts, EveryMemoryPacket) {
  Noise noise;
  std::uint64_t wrong = 0;
  for (unsigned address = 0; address < 0x10000; ++address) {
    Report report = noise.report(0x21, wire::memory::kSize);
    report.bytes[3] = static_cast<std::uint8_t>(address);  // all sizes and errors come by
    wire::memory::kAddress.write(report.bytes.data(), address);
    const unsigned error = wire::memory::kError.read(report.bytes.data());
    const std::size_t size =
        error != 0 ? 0 : wire::memory::kSizeLessOne.read(report.bytes.data()) + 1u;
    const auto packet = protocol::decodeMemoryPacket(report);
    wrong += !packet || packet->address != address || packet->error != error ||
             packet->size != size ||
             !std::equal(packet->data.begin(), packet->data.begin() + size,
                         report.bytes.begin() + wire::memory::kData);
  }
  EXPECT_EQ(wrong, 0u);
}

TEST(WireLayouts, EveryAcknowledgement) {
  Noise noise;
  std::uint64_t wrong = 0;
  for (unsigned id = 0; id < 256; ++id) {
    for (unsigned error = 0; error < 256; ++error) {
      Report report = noise.report(0x22, wire::acknowledgement::kSize);
      wire::acknowledgement::kReport.write(report.bytes.data(), id);
      wire::acknowledgement::kError.write(report.bytes.data(), error);
      const auto decoded = protocol::decodeAcknowledgement(report);
      wrong += !decoded || decoded->report_id != id || decoded->error != error;
    }
  }
  EXPECT_EQ(wrong, 0u);
}

TEST(WireLayouts, EachDecoderTakesItsOwnReportsFromTheirLengthOn) {
  Noise noise;
  for (int id = 0; id < 256; ++id) {
    std::size_t data_size = Report::kCapacity + 1;
    for (const wire::DataReport& layout : wire::kDataReports) {
      if (layout.id == id && !wire::isHalf(layout))
        data_size = layout.size;
    }
    for (std::size_t size = 0; size <= Report::kCapacity; ++size) {
      const Report report = noise.report(id, size);
      EXPECT_EQ(protocol::decodeStatus(report).has_value(), id == 0x20 && size >= 7);
      EXPECT_EQ(protocol::decodeMemoryPacket(report).has_value(), id == 0x21 && size >= 22);
      EXPECT_EQ(protocol::decodeAcknowledgement(report).has_value(), id == 0x22 && size >= 5);
      EXPECT_EQ(protocol::decodeDataReport(report).has_value(), size >= data_size)
          << "report 0x" << std::hex << id << std::dec << " of " << size << " bytes";
    }
  }
}

TEST(WireLayouts, OnlyTheTwoHalvesInTheirOrderAreAnInterleavedReport) {
  Noise noise;
  for (int first = 0x30; first < 0x40; ++first) {
    for (int second = 0x30; second < 0x40; ++second) {
      for (const std::size_t size : {std::size_t{0}, std::size_t{21}, std::size_t{22}}) {
        EXPECT_EQ(protocol::decodeInterleaved(noise.report(first, size), noise.report(second, 22))
                      .has_value(),
                  first == 0x3e && second == 0x3f && size == 22);
        EXPECT_EQ(protocol::decodeInterleaved(noise.report(first, 22), noise.report(second, size))
                      .has_value(),
                  first == 0x3e && second == 0x3f && size == 22);
      }
    }
  }
}

// ---- Output reports: rebuilt bit by bit and compared as a whole.

/// The report as it is sent while the motor runs, or rests.
Report withMotor(Report report, unsigned runs) {
  if (runs == 1)
    report.bytes[1] |= protocol::kRumbleBit;
  return report;
}

TEST(WireLayouts, EverySwitch) {
  for (const unsigned rumble : {0u, 1u}) {
    for (const unsigned on : {0u, 1u}) {
      for (const int id : {0x13, 0x1a}) {
        Report expected{static_cast<std::uint8_t>(id), 0};
        wire::output::kRumble.write(expected.bytes.data(), rumble);
        wire::output::kAcknowledge.write(expected.bytes.data(), 1);
        wire::output::kOn.write(expected.bytes.data(), on);
        const Report made =
            id == 0x13 ? protocol::setIrClock(on == 1) : protocol::setIrLogic(on == 1);
        EXPECT_EQ(withMotor(made, rumble), expected);
      }
      for (unsigned mode = 0; mode < 256; ++mode) {
        Report expected{0x12, 0, 0};
        wire::output::kRumble.write(expected.bytes.data(), rumble);
        wire::output::kAcknowledge.write(expected.bytes.data(), 1);
        wire::output::kOn.write(expected.bytes.data(), on);
        wire::output::kMode.write(expected.bytes.data(), mode);
        const auto byte = static_cast<std::uint8_t>(mode);
        EXPECT_EQ(withMotor(protocol::setReportMode(byte, on == 1), rumble), expected);
      }
    }
    for (unsigned leds = 0; leds < 256; ++leds) {
      Report expected{0x11, 0};
      wire::output::kRumble.write(expected.bytes.data(), rumble);
      wire::output::kAcknowledge.write(expected.bytes.data(), 1);
      wire::output::kLeds.write(expected.bytes.data(), leds % 16);
      const auto byte = static_cast<std::uint8_t>(leds);
      EXPECT_EQ(withMotor(protocol::setLeds(byte), rumble), expected);
    }
    Report status{0x15, 0};
    wire::output::kRumble.write(status.bytes.data(), rumble);
    EXPECT_EQ(withMotor(protocol::requestStatus(), rumble), status);
  }
}

TEST(WireLayouts, EveryReadAndWriteOfMemory) {
  Noise noise;
  std::uint64_t wrong = 0;
  for (unsigned i = 0; i < 0x10000; ++i) {
    const unsigned rumble = i / 7 % 2;
    const unsigned registers = i / 3 % 2;
    const auto space = registers == 1 ? protocol::Space::kRegisters : protocol::Space::kEeprom;
    const std::uint32_t address = i % 2 == 0 ? noise.below(1u << 24) : i << 8;

    Report read{0x17, 0};
    read.size = 7;
    wire::output::kRumble.write(read.bytes.data(), rumble);
    wire::output::kOn.write(read.bytes.data(), registers);
    wire::output::kAddress.write(read.bytes.data(), address);
    wire::output::kReadSize.write(read.bytes.data(), i);
    const Report asked = protocol::readMemory(space, address, static_cast<std::uint16_t>(i));
    wrong += !(withMotor(asked, rumble) == read);

    Report write{0x16, 0};
    write.size = 22;
    const unsigned size = i % 16 + 1;
    wire::output::kRumble.write(write.bytes.data(), rumble);
    wire::output::kOn.write(write.bytes.data(), registers);
    wire::output::kAddress.write(write.bytes.data(), address);
    wire::output::kWriteSize.write(write.bytes.data(), size);
    std::array<std::uint8_t, 16> payload{};
    for (unsigned k = 0; k < size; ++k)
      payload[k] = write.bytes[wire::output::kWriteData + k] =
          static_cast<std::uint8_t>(noise.below(256));
    const Report written = protocol::writeMemory(space, address, payload.data(), size);
    wrong += !(withMotor(written, rumble) == write);
  }
  EXPECT_EQ(wrong, 0u);
}

// ---- The EEPROM.

TEST(WireLayouts, EveryValueOfTheAccelerometerBlock) {
  Noise noise;
  for (std::size_t field = 0; field < wire::kAccelerometerBlock.size(); ++field) {
    std::uint64_t wrong = 0;
    for (unsigned value = 0; value < 1024; ++value) {
      std::array<std::uint8_t, protocol::kAccelerometerBlockSize> block{};
      std::copy_n(noise.report(0, 22).bytes.begin() + 1, block.size(), block.begin());
      wire::kAccelerometerBlock[field].write(block.data(), value);
      block[9] = wire::checksum(block.data(), 9);
      bool usable = true;
      for (std::size_t axis = 0; axis < 3; ++axis)
        usable = usable && wire::kAccelerometerBlock[axis].read(block.data()) !=
                               wire::kAccelerometerBlock[3 + axis].read(block.data());
      const auto decoded = protocol::decodeAccelerometerBlock(block);
      wrong += decoded.has_value() != usable;
      for (std::size_t axis = 0; decoded && axis < 3; ++axis) {
        wrong += decoded->at_zero_g[axis] !=
                 static_cast<int>(wire::kAccelerometerBlock[axis].read(block.data()));
        wrong += decoded->at_one_g[axis] !=
                 static_cast<int>(wire::kAccelerometerBlock[3 + axis].read(block.data()));
      }
    }
    EXPECT_EQ(wrong, 0u) << "field " << field;
  }
}

TEST(WireLayouts, EveryCoordinateOfTheIrCalibrationBlock) {
  Noise noise;
  for (std::size_t changed = 0; changed < 4; ++changed) {
    for (const bool is_x : {true, false}) {
      std::uint64_t wrong = 0;
      for (unsigned value = 0; value < 1024; ++value) {
        std::array<std::uint8_t, protocol::kIrCalibrationBlockSize> block{};
        std::set<std::pair<unsigned, unsigned>> points;
        bool on_sensor = true;
        for (std::size_t i = 0; i < 4; ++i) {
          const wire::Spot place = wire::spot(wire::Format::kBasic, i, 0);
          const unsigned x = i == changed && is_x ? value : noise.below(1024);
          const unsigned y = i == changed && !is_x ? value : noise.below(768);
          place.x.write(block.data(), x);
          place.y.write(block.data(), y);
          points.emplace(x, y);
          on_sensor = on_sensor && y < 768;
        }
        block[10] = wire::checksum(block.data(), wire::kIrCalibrationPoints);
        const auto decoded = protocol::decodeIrCalibrationBlock(block);
        wrong += decoded.has_value() != (on_sensor && points.size() == 4);
        for (std::size_t i = 0; decoded && i < 4; ++i) {
          const wire::Spot place = wire::spot(wire::Format::kBasic, i, 0);
          wrong += decoded->points[i] != std::array<int, 2>{{int(place.x.read(block.data())),
                                                             int(place.y.read(block.data()))}};
        }
      }
      EXPECT_EQ(wrong, 0u) << "point " << changed;
    }
  }
}

TEST(WireLayouts, OneChecksumOf256IsCorrect) {
  std::array<std::uint8_t, protocol::kAccelerometerBlockSize> block{
      {0x84, 0x82, 0x86, 0x30, 0x9f, 0x9d, 0x9f, 0x02, 0x40, 0}};
  for (unsigned checksum = 0; checksum < 256; ++checksum) {
    block[9] = static_cast<std::uint8_t>(checksum);
    EXPECT_EQ(protocol::decodeAccelerometerBlock(block).has_value(),
              checksum == wire::checksum(block.data(), 9));
  }
}

}  // namespace
}  // namespace wiimote_tracker
