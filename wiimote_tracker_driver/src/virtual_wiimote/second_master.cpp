#include "second_master.h"

#include <algorithm>
#include <array>

namespace wiimote_tracker::virtual_wiimote {
namespace {

// In samples: the kernel's timer of 4 s; typical intervals of user actions and programs.
constexpr std::uint64_t kMotionPlusInterval = 400;
constexpr std::uint64_t kBatteryInterval = 700;
constexpr std::uint64_t kDesktopInterval = 900;
constexpr std::uint64_t kCameraOpened = 300;
constexpr std::uint64_t kCameraClosed = 310;
constexpr std::uint64_t kLedsSet = 600;

constexpr std::uint8_t kOnlyButtons = 0x30;
constexpr std::uint8_t kWithCamera = 0x36;

/// A register write as transmitted, 22 bytes.
Bytes write(std::uint8_t high, std::uint8_t low, const Bytes& payload) {
  Bytes report(22, 0);
  const std::array<std::uint8_t, 6> head{
      {0x16, 0x04, high, 0x00, low, static_cast<std::uint8_t>(payload.size())}};
  std::copy(payload.begin(), payload.end(), std::copy(head.begin(), head.end(), report.begin()));
  return report;
}

const Bytes kStatus{0x15, 0x00};
const Bytes kLed1{0x11, 0x10};
const Bytes kReadExtensionId{0x17, 0x04, 0xa4, 0x00, 0xfa, 0x00, 0x06};
const Bytes kReadMotionPlusId{0x17, 0x04, 0xa6, 0x00, 0xfa, 0x00, 0x06};

void append(std::vector<Bytes>& to, const std::vector<Bytes>& more) {
  to.insert(to.end(), more.begin(), more.end());
}

Bytes setMode(std::uint8_t mode) {
  return {0x12, 0x00, mode};
}

std::vector<Bytes> setUp() {
  return {kStatus,
          kLed1,
          write(0xa4, 0xf0, {0x55}),
          write(0xa6, 0xf0, {0x55}),
          kReadMotionPlusId,
          kReadExtensionId,
          kStatus};
}

/// For the basic format at the console's middle level, whatever was set before.
std::vector<Bytes> openCamera() {
  return {{0x13, 0x06},
          {0x1a, 0x06},
          write(0xb0, 0x30, {0x01}),
          write(0xb0, 0x00, {0x02, 0x00, 0x00, 0x71, 0x01, 0x00, 0xaa, 0x00, 0x64}),
          write(0xb0, 0x1a, {0x63, 0x03}),
          write(0xb0, 0x33, {0x01}),
          write(0xb0, 0x30, {0x08}),
          setMode(kWithCamera)};
}

std::vector<Bytes> closeCamera() {
  return {{0x13, 0x00}, {0x1a, 0x00}, setMode(kOnlyButtons)};
}

}  // namespace

std::vector<Bytes> SecondMaster::tick() {
  ++samples_;
  std::vector<Bytes> reports;
  if (samples_ == 1)
    append(reports, setUp());
  if (samples_ % kMotionPlusInterval == 0)
    append(reports, {kReadExtensionId, write(0xa6, 0xf0, {0x55}), kReadMotionPlusId});
  if (samples_ % kBatteryInterval == 0)
    reports.push_back(kStatus);
  const std::uint64_t desktop = samples_ % kDesktopInterval;
  if (desktop == kLedsSet)
    reports.push_back(kLed1);
  if (desktop == kCameraOpened) {
    mode_ = kWithCamera;
    append(reports, openCamera());
  }
  if (desktop == kCameraClosed) {
    mode_ = kOnlyButtons;
    append(reports, closeCamera());
  }
  return reports;
}

std::vector<Bytes> SecondMaster::receive(const Bytes& report) const {
  if (report[0] != 0x20)
    return {};
  return {setMode(mode_)};
}

}  // namespace wiimote_tracker::virtual_wiimote
