// Statuses, asked for or not, and what the kernel's driver does after each, in fake time.
#include "wiimote_fixture.h"

#include <gtest/gtest.h>

namespace wiimote_tracker::wiimote {
namespace {

TEST_F(WiimoteTest, StatusThatNobodyAskedForStopsNothing) {
  runToImage();
  remote_.mode = 0x30;  // an extension was plugged in: reporting stops
  remote_.say({0x20, 0, 0, 0x1a, 0, 0, 0x8f});
  const double then = remote_.now;
  runToImage();
  EXPECT_EQ(kReport33, remote_.written.back().report);
  EXPECT_LT(remote_.now - then, 0.05);
  EXPECT_EQ(0u, wiimote_.link().clock_epoch);
}

TEST_F(WiimoteTest, KernelThatResetsTheModeAfterEachStatusIsOvercome) {
  runToImage();
  // The kernel's 12 00 30 arrives after our own 0x12, and the remote sends one report 0x30.
  remote_.say({0x20, 0, 0, 0x18, 0, 0, 0x8f});
  run(0.007);
  remote_.mode = 0x30;
  remote_.say({0x22, 0, 0, 0x12, 0});
  remote_.say({0x30, 0, 0});
  const double then = remote_.now;
  runToImage();
  EXPECT_LT(remote_.now - then, 0.1);
  EXPECT_EQ(0u, wiimote_.link().clock_epoch);
  EXPECT_EQ(0u, wiimote_.link().restorations) << "this happens every minute";
  EXPECT_EQ(1, remote_.count(kVerify));
}

TEST_F(WiimoteTest, ModeThatTheKernelResetsSilentlyAfterAStatusCostsFewImages) {
  runToImage();
  remote_.say({0x20, 0, 0, 0x18, 0, 0, 0x8f});
  run(0.008);
  // The kernel's 12 00 30 has overtaken ours; nothing changes, so the remote sends nothing more.
  remote_.mode = 0x30;
  const double then = remote_.now;
  runToImage();
  EXPECT_LT(remote_.now - then, 0.045);
  EXPECT_EQ(0u, wiimote_.link().restorations);
}

TEST_F(WiimoteTest, StatusWithTheCameraOffCausesACheck) {
  runToImage();
  remote_.camera = false;
  remote_.say({0x20, 0, 0, 0x10, 0, 0, 0x8f});
  run(0.15);
  EXPECT_TRUE(remote_.camera);
  run(0.05);
  EXPECT_EQ("the camera was switched off", wiimote_.link().last_restoration);
}

TEST_F(WiimoteTest, TheReportRightAfterAModeIsNoNewImage) {
  runToImage();
  int images = 0;
  for (int i = 0; i < 40; ++i) {
    remote_.say({0x20, 0, 0, 0x18, 0, 0, 0x8f});  // the mode is then set again, and answered
    images += run(0.25);
  }
  EXPECT_NEAR(1000, images, 2);
  EXPECT_LE(40, remote_.count({0x12, 0x06, 0x33}));
}

TEST_F(WiimoteTest, AnImageAtItsRegularTimeIsNoEchoOfAMode) {
  remote_.echoes = false;
  runToImage();
  int images = 0;
  for (int i = 0; i < 40; ++i) {
    remote_.say({0x20, 0, 0, 0x18, 0, 0, 0x8f});
    images += run(0.2513);  // at another phase between two images each time
  }
  EXPECT_NEAR(1005, images, 1);
}

TEST_F(WiimoteTest, BatteryIsRequestedRegularly) {
  runToImage();
  const int images = run(121.0);
  EXPECT_EQ(3, remote_.count(kStatusRequest));
  EXPECT_NEAR(12100, images, 20);
  EXPECT_EQ(kReport33, remote_.written.back().report);
}

TEST_F(WiimoteTest, RequestsForTheBatteryCostNoImage) {
  runToImage();
  const int images = run(59.0);
  ASSERT_EQ(1, remote_.count(kStatusRequest));
  EXPECT_NEAR(100, run(1.5) - 50, 1);
  EXPECT_EQ(2, remote_.count(kStatusRequest));
  EXPECT_NEAR(5900, images, 1);
}

TEST_F(WiimoteTest, LedsSwitchedByOthersAreSetAgainAfterTheNextStatus) {
  runToImage();
  remote_.leds = 0x8;
  run(61.0);
  EXPECT_EQ(0x1, remote_.leds);
}

}  // namespace
}  // namespace wiimote_tracker::wiimote
