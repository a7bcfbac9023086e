// Reports cause no allocation after warm-up.
#include "allocation_counter.h"
#include "fake_remote.h"

#include "wiimote/wiimote.h"

#include <gtest/gtest.h>

#include <memory>

namespace wiimote_tracker::wiimote {
namespace {

TEST(AllocationCounter, Counts) {
  const Allocations before = allocations();
  auto number = std::make_unique<int>(1);
  EXPECT_EQ(allocations().made, before.made + 1);
  EXPECT_EQ(allocations().alive, before.alive + 1);
  number.reset();
  EXPECT_EQ(allocations().alive, before.alive);
}

class NoAllocation : public testing::TestWithParam<protocol::IrFormat> {};

TEST_P(NoAllocation, PerReportInAnHour) {
  FakeRemote remote;
  remote.remembers = false;
  Options options;
  options.ir_format = GetParam();
  Wiimote wiimote(
      options, [&](bool) { return remote.open(); }, [&] { return remote.now; });
  while (wiimote.link().state != Link::State::kStreaming) {
    wiimote.step(0.1);
    ASSERT_LT(remote.now, 110.0);
  }

  // Includes requests for the battery and checks of the camera.
  const double end = remote.now + 3600.0;
  const std::uint64_t sent = remote.sent;
  const std::uint64_t made = allocations().made;
  std::uint64_t images = 0;
  std::uint64_t lights = 0;
  while (remote.now < end) {
    if (const auto image = wiimote.step(0.1)) {
      ++images;
      lights += image->spots[0].seen;
    }
  }
  EXPECT_EQ(allocations().made, made);
  const std::uint64_t per_image = GetParam() == protocol::IrFormat::kFull ? 2 : 1;
  const std::uint64_t complete = (remote.sent - sent) / per_image;
  EXPECT_GT(complete, 350000u / per_image);
  // After each of 60 statuses the mode is set twice: an image that comes at once counts as the
  // mode's echo, and a pair may restart.
  EXPECT_GE(images + 121, complete);
  EXPECT_GT(lights, images / 2);
}

INSTANTIATE_TEST_SUITE_P(Formats,
                         NoAllocation,
                         testing::Values(protocol::IrFormat::kBasic,
                                         protocol::IrFormat::kExtended,
                                         protocol::IrFormat::kFull));

TEST(NoAllocation, WhenSettingsChange) {
  FakeRemote remote;
  remote.remembers = false;
  Wiimote wiimote(
      Options(), [&](bool) { return remote.open(); }, [&] { return remote.now; });
  while (wiimote.link().state != Link::State::kStreaming) {
    wiimote.step(0.1);
    ASSERT_LT(remote.now, 110.0);
  }
  const auto bright = *protocol::irSensitivity("max");
  const auto dim = *protocol::irSensitivity("wii_1");
  const std::uint64_t made = allocations().made;
  std::uint64_t images = 0;
  for (int i = 0; i < 10000; ++i) {
    if (i % 500 == 0)
      wiimote.setSensitivity(i % 1000 == 0 ? bright : dim);
    if (i % 300 == 0)
      wiimote.setLeds(static_cast<std::uint8_t>(i / 300 % 16));
    images += wiimote.step(0.1).has_value();
  }
  EXPECT_EQ(allocations().made, made);
  EXPECT_GT(images, 9000u);
}

}  // namespace
}  // namespace wiimote_tracker::wiimote
