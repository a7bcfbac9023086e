// Remotes that answer anything at any time, in fake time.
#include "wiimote_fixture.h"

#include <gtest/gtest.h>

#include <random>

namespace wiimote_tracker::wiimote {
namespace {

using protocol::Report;

TEST(HostileRemote, EachReportCausesFewWritesAndEveryWaitEnds) {
  std::mt19937 random(11);
  int sessions = 0;
  for (int i = 0; i < 300; ++i) {
    Options options;
    options.ir_format =
        std::array<protocol::IrFormat, 3>{protocol::IrFormat::kBasic, protocol::IrFormat::kExtended,
                                          protocol::IrFormat::kFull}[random() % 3];
    Report asked;
    int written = 0;
    double now = 0.0;
    try {
      Session session(
          options,
          [&](const Report& report) {
            asked = report;
            ++written;
          },
          now);
      ++sessions;
      for (int j = 0; j < 2000; ++j) {
        // Mostly likely answers, sometimes far from them.
        Report report;
        report.size = Report::kCapacity;
        for (std::uint8_t& byte : report.bytes)
          byte = static_cast<std::uint8_t>(random());
        report.bytes[0] = static_cast<std::uint8_t>(
            random() % 8 == 0 ? random() : 0x20 + (random() % 3 == 0 ? 0x10 : 0) + random() % 3);
        if (report.bytes[0] == 0x22 && random() % 8 != 0) {
          report.bytes[3] = asked.bytes[0];
          report.bytes[4] = random() % 4 == 0 ? 7 : 0;
        } else if (report.bytes[0] == 0x21 && random() % 8 != 0) {
          report.bytes[3] = static_cast<std::uint8_t>((asked.bytes[6] + 15) % 16 << 4);
          report.bytes[4] = asked.bytes[3];
          report.bytes[5] = asked.bytes[4];
        }
        written = 0;
        session.handle(report, now);
        session.tick(now);
        EXPECT_LE(written, 6);
        now += 0.001 * static_cast<double>(random() % 20);
      }
      // It then says nothing more.
      for (const double end = now + 60.0; now < end; now += 0.01)
        session.tick(now);
      ADD_FAILURE() << "session " << i << " waits for a silent remote";
    } catch (const SessionError&) {
      // It gave up, at the answers or at the silence.
    }
  }
  EXPECT_EQ(300, sessions);
}

TEST(HostileRemote, OneThatNeverSendsAnImageIsGivenUpWhateverElseItSends) {
  // Always answers as asked, but with these reports all the time.
  for (const Report& noise : std::vector<Report>{{0x30, 0, 0},
                                                 {0x31, 0, 0, 0, 0, 0},
                                                 {0x20, 0, 0, 0x18, 0, 0, 0x8f},
                                                 {0x22, 0, 0, 0x12, 0},
                                                 {0x22, 0, 0, 0x17, 4},
                                                 {0x3f, 0, 0},
                                                 {0x33, 0}}) {
    FakeRemote remote;
    Wiimote wiimote(
        Options(), [&](bool) { return remote.open(); }, [&] { return remote.now; });
    remote.lose = [&](const Report& report) {
      if (report.bytes[0] == 0x12)
        remote.say({0x22, 0, 0, 0x12, 0}, 0.005);
      return report.bytes[0] == 0x12;
    };
    double next_noise = remote.now;
    while (remote.opened < 2 && remote.now < 160.0) {
      if (remote.now >= next_noise) {
        remote.say(noise);
        next_noise = remote.now + 0.01;
      }
      wiimote.step(std::max(0.001, std::min(0.01, next_noise - remote.now)));
      if (wiimote.idleTime() > 0.0)
        remote.now += wiimote.idleTime();
    }
    EXPECT_EQ(2, remote.opened) << "noise " << int{noise.bytes[0]};
    EXPECT_FALSE(wiimote.link().error.empty());
  }
}

}  // namespace
}  // namespace wiimote_tracker::wiimote
