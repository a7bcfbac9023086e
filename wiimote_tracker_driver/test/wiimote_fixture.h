#pragma once

#include "fake_remote.h"
#include "wiimote/wiimote.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace wiimote_tracker::wiimote {

/// A register write as it crosses the wire.
inline protocol::Report write(std::uint8_t address, std::vector<std::uint8_t> data) {
  protocol::Report report{0x16, 0x04, 0xb0, 0x00, address, static_cast<std::uint8_t>(data.size())};
  std::copy(data.begin(), data.end(), report.bytes.begin() + 6);
  report.size = 22;
  return report;
}

inline const protocol::Report kStatusRequest{0x15, 0x00};
inline const protocol::Report kLedOne{0x11, 0x12};
inline const protocol::Report kReadIrBlock{0x17, 0x00, 0x00, 0x00, 0x00, 0x00, 0x0b};
inline const protocol::Report kReadIrCopy{0x17, 0x00, 0x00, 0x00, 0x0b, 0x00, 0x0b};
inline const protocol::Report kReadBlock{0x17, 0x00, 0x00, 0x00, 0x16, 0x00, 0x0a};
inline const protocol::Report kReadCopy{0x17, 0x00, 0x00, 0x00, 0x20, 0x00, 0x0a};
inline const protocol::Report kClock{0x13, 0x06};
inline const protocol::Report kLogic{0x1a, 0x06};
inline const protocol::Report kSetup = write(0x30, {0x01});
inline const protocol::Report kBlock1 = write(0x00, {0x07, 0, 0, 0x71, 0x01, 0, 0x72, 0, 0x20});
inline const protocol::Report kBlock2 = write(0x1a, {0x1f, 0x03});
inline const protocol::Report kMode = write(0x33, {0x03});
inline const protocol::Report kRun = write(0x30, {0x08});
inline const protocol::Report kVerify{0x17, 0x04, 0xb0, 0x00, 0x30, 0x00, 0x04};
inline const protocol::Report kVerifyBlock1{0x17, 0x04, 0xb0, 0x00, 0x00, 0x00, 0x09};
inline const protocol::Report kVerifyBlock2{0x17, 0x04, 0xb0, 0x00, 0x1a, 0x00, 0x02};
inline const protocol::Report kReport33{0x12, 0x06, 0x33};

inline const std::vector<protocol::Report> kHandshake{
    kStatusRequest, kLedOne, kReadIrBlock,  kReadBlock,    kClock,
    kLogic,         kSetup,  kBlock1,       kBlock2,       kMode,
    kRun,           kVerify, kVerifyBlock1, kVerifyBlock2, kReport33};

/// A Wiimote with a FakeRemote, in fake time.
class WiimoteTest : public testing::Test {
 protected:
  explicit WiimoteTest(const Options& options = Options())
      : wiimote_(
            options,
            [this](bool) { return remote_.open(); },
            [this] { return remote_.now; }) {}

  /// Advances the time. @returns the number of images.
  int run(double duration) {
    const double end = remote_.now + duration;
    int images = 0;
    while (remote_.now < end) {
      if (const double idle = wiimote_.idleTime())
        remote_.now = std::min(end, remote_.now + idle);
      if (const auto image = wiimote_.step(std::max(0.0, std::min(0.1, end - remote_.now)))) {
        ++images;
        last_ = *image;
      }
    }
    return images;
  }

  /// Runs until an image has come; fails when none does within a minute.
  void runToImage() {
    const double end = remote_.now + 60.0;
    while (remote_.now < end) {
      if (run(0.01) > 0)
        return;
    }
    FAIL() << "no image";
  }

  bool streaming() const { return wiimote_.link().state == Link::State::kStreaming; }

  FakeRemote remote_;
  Wiimote wiimote_;
  protocol::DataReport last_;
};

}  // namespace wiimote_tracker::wiimote
