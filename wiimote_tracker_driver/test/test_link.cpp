// How the driver keeps a connection, in fake time: remotes that are silent, absent or go away.
#include "wiimote_fixture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <new>
#include <stdexcept>
#include <utility>

namespace wiimote_tracker::wiimote {
namespace {

using protocol::Report;

TEST_F(WiimoteTest, ASilentRemoteIsReconnected) {
  remote_.answers = false;
  run(2.6);
  EXPECT_EQ(5, remote_.count(kStatusRequest));
  EXPECT_EQ(Link::State::kSearching, wiimote_.link().state);
  EXPECT_NE(std::string::npos, wiimote_.link().error.find("does not answer report 0x15"));
  remote_.answers = true;
  runToImage();
  EXPECT_TRUE(streaming());
  EXPECT_EQ("", wiimote_.link().error);
  EXPECT_EQ(2, remote_.opened);
  EXPECT_EQ(0u, wiimote_.link().clock_epoch) << "the first stream is epoch 0";
}

TEST_F(WiimoteTest, AnyExceptionEndsTheConnectionAndNothingElse) {
  int failures = 1;
  Wiimote wiimote(
      Options(),
      [&](bool) -> std::unique_ptr<transport::Transport> {
        if (failures-- > 0)
          throw std::bad_alloc();
        return remote_.open();
      },
      [&] { return remote_.now; });
  EXPECT_NO_THROW(wiimote.step(0.1));
  EXPECT_EQ(Link::State::kSearching, wiimote.link().state);
  EXPECT_NE("", wiimote.link().error);
  remote_.now += 1.0;
  remote_.lose = [](const Report&) -> bool { throw std::logic_error("of the transport"); };
  EXPECT_NO_THROW(wiimote.step(0.1));
  EXPECT_EQ("of the transport", wiimote.link().error);
  EXPECT_NO_THROW(wiimote.close());
}

TEST_F(WiimoteTest, DisconnectAndReconnect) {
  runToImage();
  remote_.present = false;
  run(3.0);
  EXPECT_EQ(Link::State::kSearching, wiimote_.link().state);
  EXPECT_EQ("no fake remote is connected", wiimote_.link().error);
  EXPECT_EQ(0u, wiimote_.link().clock_epoch);
  remote_.powerCycle();
  remote_.present = true;
  const double then = remote_.now;
  runToImage();
  EXPECT_LT(remote_.now - then, 1.0) << "longest pause between attempts is 0.5 s";
  EXPECT_EQ(1u, wiimote_.link().clock_epoch);
  EXPECT_TRUE(streaming());
}

TEST_F(WiimoteTest, RemoteThatIsNotThereYetIsLookedForWithGrowingPauses) {
  FakeRemote remote;
  std::vector<double> attempts;
  Wiimote wiimote(
      Options(),
      [&](bool) -> std::unique_ptr<transport::Transport> {
        attempts.push_back(remote.now);
        if (attempts.size() < 7)
          throw transport::NoSuchDevice("none");
        return remote.open();
      },
      [&] { return remote.now; });
  bool image = false;
  while (!image && remote.now < 160.0) {
    remote.now += wiimote.idleTime();
    image = wiimote.step(0.1).has_value();
  }
  EXPECT_TRUE(image);
  const std::vector<double> pauses{0.25, 0.5, 0.5, 0.5, 0.5, 0.5};
  ASSERT_EQ(pauses.size() + 1, attempts.size());
  for (std::size_t i = 0; i < pauses.size(); ++i)
    EXPECT_NEAR(pauses[i], attempts[i + 1] - attempts[i], 1e-9);
}

// Before the images that waited comes an answer.
TEST_F(WiimoteTest, AStallIsNotTakenForStoppedImages) {
  runToImage();
  for (const double stall : {0.55, 2.0}) {
    run(0.5);
    remote_.say({0x22, 0, 0, 0x11, 0});
    remote_.now += stall;
    run(0.5);
    EXPECT_EQ(0u, wiimote_.link().restorations) << wiimote_.link().last_restoration;
  }
}

// The kernel keeps the oldest 63 reports of a stall.
TEST_F(WiimoteTest, BacklogOfAStallThatTheBufferCannotHoldIsDropped) {
  runToImage();
  run(0.5);
  for (const double stall : {0.3, 0.65, 2.0}) {
    const int waiting = std::min(63, static_cast<int>(100.0 * stall));
    remote_.now += stall;
    Report image{0x33, 0, 0, 0x80, 0x80, 0x80, 0x23, 0x45, 0x13};
    image.size = 18;
    for (std::size_t i = 9; i < image.size; ++i)
      image.bytes[i] = 0xff;
    for (int i = 0; i < waiting; ++i)
      remote_.say(image);
    const int images = run(0.5);
    EXPECT_NEAR(stall < 0.6 ? waiting + 50 : 50, images, 2) << "stall of " << stall << " s";
    EXPECT_TRUE(streaming());
    EXPECT_EQ(0u, wiimote_.link().clock_epoch);
  }
}

// A reader that takes 20 ms for each image: a queue of 100 reports.
TEST_F(WiimoteTest, OfAQueueThatNeverEmptiesImagesAreKnownToHaveWaitedAndThenDropped) {
  runToImage();
  run(0.5);
  EXPECT_FALSE(wiimote_.imageWaited());
  Report image{0x33, 0, 0, 0x80, 0x80, 0x80, 0x23, 0x45, 0x13};
  image.size = 18;
  std::fill(image.bytes.begin() + 9, image.bytes.begin() + 18, std::uint8_t{0xff});
  for (int i = 0; i < 100; ++i) {
    image.bytes[5] = static_cast<std::uint8_t>(0x80 | (i & 1));
    remote_.say(image);
  }
  const double begin = remote_.now;
  int images = 0;
  for (int i = 0; i < 100; ++i) {
    remote_.now += 0.02;
    const bool came = wiimote_.step(0.0).has_value();
    images += came;
    EXPECT_TRUE(!came || wiimote_.imageWaited()) << i;
    EXPECT_TRUE(!came || remote_.now - begin < 0.62) << i;
  }
  EXPECT_NEAR(30, images, 2);
  EXPECT_GT(run(0.5), 40) << "once none waits, images come again";
  EXPECT_FALSE(wiimote_.imageWaited());
}

TEST_F(WiimoteTest, AClockEpochBeginsWithAnImageThatDidNotWait) {
  bool image = false;
  for (int i = 0; i < 30 && !image; ++i) {
    remote_.now += 0.02;
    image = wiimote_.step(0.0).has_value();
  }
  EXPECT_GT(remote_.sent, 0u);
  EXPECT_FALSE(image);
  EXPECT_GT(run(0.5), 40);
  EXPECT_FALSE(wiimote_.imageWaited());
}

// The process is stopped while it waits for a report, as by a busy computer.
class Oversleeping : public FakeTransport {
 public:
  Oversleeping(FakeRemote* remote, double* stop)
      : FakeTransport(remote), remote_(remote), stop_(stop) {}
  bool read(protocol::Report& report, double timeout) override {
    const bool received = FakeTransport::read(report, timeout);
    if (timeout > 0.0)
      remote_->now += std::exchange(*stop_, 0.0);
    return received;
  }

 private:
  FakeRemote* remote_;
  double* stop_;
};

TEST(OversleepingTest, ImagesOfAStopWhileWaitingForAReportAreKnownToHaveWaited) {
  FakeRemote remote;
  double stop = 0.0;
  Wiimote wiimote(
      Options(), [&](bool) { return std::make_unique<Oversleeping>(&remote, &stop); },
      [&] { return remote.now; });
  const auto run = [&](double duration) {  // @returns images that waited, and others
    std::pair<int, int> images;
    for (const double end = remote.now + duration; remote.now < end;) {
      if (wiimote.step(0.1))
        ++(wiimote.imageWaited() ? images.first : images.second);
    }
    return images;
  };
  run(2.0);
  EXPECT_EQ(0, run(0.5).first);
  Report image{0x33, 0, 0, 0x80, 0x80, 0x80, 0x23, 0x45, 0x13};
  image.size = 18;
  std::fill(image.bytes.begin() + 9, image.bytes.begin() + 18, std::uint8_t{0xff});
  stop = 0.3;
  for (int i = 0; i < 30; ++i) {
    image.bytes[5] = static_cast<std::uint8_t>(0x80 | (i & 1));
    remote.say(image, 0.02 + 0.01 * i);
  }
  const auto images = run(0.5);
  EXPECT_NEAR(30, images.first, 2);
  EXPECT_NEAR(20, images.second, 2);
}

TEST_F(WiimoteTest, CloseSwitchesTheRemoteOff) {
  runToImage();
  wiimote_.close();
  EXPECT_EQ(0x30, remote_.mode);
  EXPECT_FALSE(remote_.camera);
  EXPECT_EQ(0, remote_.leds);
  EXPECT_EQ(Link::State::kSearching, wiimote_.link().state);
  remote_.present = false;
  EXPECT_NO_THROW(wiimote_.close());
}

TEST_F(WiimoteTest, CloseOfARemoteThatHasGoneIsHarmless) {
  runToImage();
  remote_.present = false;
  EXPECT_NO_THROW(wiimote_.close());
}

TEST_F(WiimoteTest, RemoteThatAcknowledgesButSendsNoImagesIsGivenUp) {
  runToImage();
  remote_.lose = [&](const Report& report) {
    if (report == kReport33)
      remote_.say({0x22, 0, 0, 0x12, 0}, 0.005);
    return report == kReport33;
  };
  remote_.mode = 0x30;
  run(5.0);
  EXPECT_EQ(2, remote_.opened);
  EXPECT_NE(std::string::npos, wiimote_.link().error.find("sends no images"));
}

TEST_F(WiimoteTest, RestorationsAreCountedOverReconnects) {
  for (std::uint64_t times = 1; times <= 2; ++times) {
    runToImage();
    remote_.camera = false;
    run(1.0);
    EXPECT_EQ(times, wiimote_.link().restorations);
    remote_.present = false;
    run(1.0);
    remote_.powerCycle();
    remote_.present = true;
  }
}

}  // namespace
}  // namespace wiimote_tracker::wiimote
