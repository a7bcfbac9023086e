// Faults on demand between the virtual remote and its host.
#include "temporary_folder.h"
#include "virtual_remote_bytes.h"
#include "virtual_wiimote/faulty_device.h"
#include "waiting.h"
#include "wiimote/wiimote.h"
#include "wiimote_tracker_driver/virtual_wiimote/server.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>

namespace wiimote_tracker::virtual_wiimote {
namespace {

const Bytes kStatus{0x20, 0, 0, 0x00, 0, 0, 0xa0};
const Bytes kAskStatus{0x15, 0x00};
const Bytes kContinuous30{0x12, 0x04, 0x30};
const Bytes kAsked30{0x12, 0x06, 0x30};

/// All reports to the host in this number of samples.
std::vector<Bytes> samples(FaultyDevice& device, int count, const Senses& senses = Senses()) {
  std::vector<Bytes> all;
  for (int i = 0; i < count; ++i) {
    for (const Bytes& report : device.sample(senses))
      all.push_back(report);
  }
  return all;
}

std::ptrdiff_t countOf(const std::vector<Bytes>& reports, std::uint8_t id) {
  return std::count_if(reports.begin(), reports.end(),
                       [id](const Bytes& report) { return report[0] == id; });
}

/// A second of buttons that identify the samples.
Senses counted(int i) {
  Senses senses;
  senses.buttons = static_cast<std::uint16_t>((i / 32 % 32) << 8 | (i % 32));
  return senses;
}

TEST(Faults, WithoutFaultsItIsTheDevice) {
  Device device;
  FaultyDevice faulty{Device::Options()};
  std::vector<Bytes> outputs = handshake();
  outputs.push_back(kAskStatus);
  outputs.push_back({0x17, 0x00, 0x00, 0x00, 0x00, 0x00, 0x40});
  for (const Bytes& output : outputs)
    EXPECT_EQ(device.handleOutput(output), faulty.handleOutput(output));
  for (int i = 0; i < 50; ++i) {
    const std::optional<Bytes> report = device.sample(counted(i));
    EXPECT_EQ(report ? Answers{*report} : Answers{}, faulty.sample(counted(i)));
  }
  EXPECT_EQ(Answers{*device.setNunchuk(true)}, faulty.setNunchuk(true));
}

TEST(Faults, SameSeedGivesSameFaults) {
  const auto all = [](std::uint32_t seed) {
    Faults faults;
    faults.seed = seed;
    faults.lost_data = faults.lost_answers = faults.late_answers = 0.2;
    faults.duplicated = faults.truncated = faults.garbage = faults.stalls = 0.1;
    FaultyDevice device(Device::Options(), faults);
    device.handleOutput(kContinuous30);
    std::vector<Bytes> reports;
    for (int i = 0; i < 200; ++i) {
      for (const Bytes& report : device.handleOutput(kAskStatus))
        reports.push_back(report);
      for (const Bytes& report : device.sample(counted(i)))
        reports.push_back(report);
    }
    return reports;
  };
  EXPECT_EQ(all(3), all(3));
  EXPECT_NE(all(3), all(4));
}

TEST(Faults, LostAnswersLeaveDataAlone) {
  Faults faults;
  faults.lost_answers = 1.0;
  FaultyDevice device(Device::Options(), faults);
  EXPECT_TRUE(device.handleOutput(kAskStatus).empty());
  EXPECT_EQ(Answers{(Bytes{0x30, 0, 0})}, device.handleOutput(kAsked30)) << "without its answer";
  device.handleOutput(kContinuous30);
  EXPECT_EQ(10u, samples(device, 10).size());
}

TEST(Faults, LostDataLeavesAnswersAlone) {
  Faults faults;
  faults.lost_data = 0.25;
  FaultyDevice device(Device::Options(), faults);
  device.handleOutput(kContinuous30);
  EXPECT_NEAR(750, samples(device, 1000).size(), 60);
  for (int i = 0; i < 100; ++i)
    EXPECT_EQ(Answers{kStatus}, device.handleOutput(kAskStatus));
}

TEST(Faults, LateAnswersComeOnceAndMayBeOvertaken) {
  Faults faults;
  faults.late_answers = 1.0;
  faults.late_by = 5;
  FaultyDevice device(Device::Options(), faults);
  EXPECT_EQ(0, countOf(device.handleOutput({0x12, 0x06, 0x30}), 0x22));
  EXPECT_TRUE(device.handleOutput(kAskStatus).empty());
  const std::vector<Bytes> all = samples(device, 5);
  EXPECT_EQ(1, countOf(all, 0x22));
  EXPECT_EQ(1, countOf(all, 0x20));
  EXPECT_EQ(5, countOf(all, 0x30));
  EXPECT_EQ(5u, samples(device, 5).size());
}

TEST(Faults, Duplicates) {
  Faults faults;
  faults.duplicated = 1.0;
  FaultyDevice device(Device::Options(), faults);
  EXPECT_EQ((Answers{kStatus, kStatus}), device.handleOutput(kAskStatus));
}

TEST(Faults, TruncatedReportsKeepTheirBeginning) {
  Faults faults;
  faults.truncated = 1.0;
  FaultyDevice device(Device::Options(), faults);
  std::size_t shortest = kStatus.size();
  for (int i = 0; i < 100; ++i) {
    const Answers answers = device.handleOutput(kAskStatus);
    ASSERT_EQ(1u, answers.size());
    ASSERT_FALSE(answers[0].empty());
    shortest = std::min(shortest, answers[0].size());
    EXPECT_TRUE(std::equal(answers[0].begin(), answers[0].end(), kStatus.begin()));
  }
  EXPECT_EQ(1u, shortest);
}

TEST(Faults, GarbageIsNeverData) {
  Faults faults;
  faults.garbage = 1.0;
  FaultyDevice device(Device::Options(), faults);
  const std::vector<Bytes> all = samples(device, 500);  // changes only: there are none
  EXPECT_EQ(500u, all.size() - static_cast<std::size_t>(countOf(all, 0x30)));
  for (const Bytes& report : all) {
    EXPECT_TRUE(report.size() <= 22);
    EXPECT_TRUE(report[0] <= 0x22 || report[0] >= 0x40 || report == (Bytes{0x30, 0, 0}));
  }
  EXPECT_NEAR(250, countOf(all, 0x20) + countOf(all, 0x21) + countOf(all, 0x22), 50);
}

TEST(Faults, StallsDelayAllReportsAndLoseNone) {
  Faults faults;
  faults.stalls = 0.1;
  faults.stall_length = 10;
  FaultyDevice device(Device::Options(), faults);
  device.handleOutput(kContinuous30);
  std::vector<Bytes> all;
  std::size_t most = 0;
  for (int i = 0; i < 500; ++i) {
    const std::vector<Bytes> reports = device.sample(counted(i));
    most = std::max(most, reports.size());
    all.insert(all.end(), reports.begin(), reports.end());
  }
  EXPECT_EQ(11u, most);
  device.setFaults(Faults());
  for (const Bytes& report : samples(device, 11, counted(0)))
    all.push_back(report);
  ASSERT_EQ(511u, all.size());
  for (int i = 0; i < 500; ++i) {
    const std::uint16_t buttons = counted(i).buttons;
    EXPECT_EQ(buttons >> 8 & 0x1f, all[static_cast<std::size_t>(i)][1]);
    EXPECT_EQ(buttons & 0x1f, all[static_cast<std::size_t>(i)][2]);
  }
}

TEST(Faults, UnpluggedRemoteComesBackPowerCycled) {
  Faults faults;
  faults.unplug_every = 20;
  faults.unplug_for = 5;
  FaultyDevice device(Device::Options(), faults);
  device.handleOutput({0x11, 0x10});
  device.handleOutput(kContinuous30);
  EXPECT_EQ(19u, samples(device, 19).size());
  EXPECT_FALSE(device.away());
  EXPECT_TRUE(device.sample(Senses()).empty());
  EXPECT_TRUE(device.away());
  EXPECT_TRUE(device.handleOutput(kAskStatus).empty());
  EXPECT_TRUE(samples(device, 4).empty());
  EXPECT_TRUE(device.away());
  samples(device, 1);
  EXPECT_FALSE(device.away());
  EXPECT_EQ(0, device.device().leds());
  EXPECT_EQ(Answers{kStatus}, device.handleOutput(kAskStatus));
}

TEST(Faults, SecondMasterDoesWhatTheKernelDoes) {
  Faults faults;
  faults.second_master = true;
  FaultyDevice device(Device::Options(), faults);
  const Senses senses = lights({{100, 50, 2, 1}});
  samples(device, 1);
  EXPECT_EQ(1, device.device().leds());

  // Our request for the battery ends our stream, and the motor stops.
  for (const Bytes& output : handshake())
    device.handleOutput(output);
  device.handleOutput({0x10, 0x01});
  EXPECT_EQ(1, countOf(samples(device, 1, senses), 0x33));
  const Answers answers = device.handleOutput(kAskStatus);
  EXPECT_EQ(1, countOf(answers, 0x20));
  EXPECT_EQ(1, countOf(answers, 0x30)) << "the report that follows its 12 00 30";
  EXPECT_FALSE(device.device().rumble());
  EXPECT_TRUE(samples(device, 10, senses).empty());

  // The second master's own traffic: foreign answers, here of the search for a MotionPlus after 4
  // s.
  const std::vector<Bytes> later = samples(device, 400, senses);
  EXPECT_NE(0, std::count(later.begin(), later.end(), (Bytes{0x22, 0, 0, 0x16, 0x07})));
  EXPECT_NE(0, countOf(later, 0x21));
  // It also opens its camera, which changes ours.
  EXPECT_NE(0, countOf(later, 0x36));
  EXPECT_EQ((Answers{{0x22, 0, 0, 0x16, 0x07}}),
            device.handleOutput(write(0x04, {0xb0, 0x00, 0x30}, {0x08})))
      << "and closed it: the camera is off";
}

TEST(Faults, AreSetByName) {
  Faults faults;
  for (const char* text :
       {"lost_answers=0.25", "lost_data=0.1", "late_answers=0.2", "duplicated=0.3", "truncated=0.4",
        "garbage=0.5", "stalls=0.6", "late_by=30", "stall_length=8", "unplug_every=1000",
        "unplug_for=50", "second_master=1", "seed=7"})
    setFault(faults, text);
  EXPECT_EQ(0.25, faults.lost_answers);
  EXPECT_EQ(0.1, faults.lost_data);
  EXPECT_EQ(0.2, faults.late_answers);
  EXPECT_EQ(0.3, faults.duplicated);
  EXPECT_EQ(0.4, faults.truncated);
  EXPECT_EQ(0.5, faults.garbage);
  EXPECT_EQ(0.6, faults.stalls);
  EXPECT_EQ(30, faults.late_by);
  EXPECT_EQ(8, faults.stall_length);
  EXPECT_EQ(1000, faults.unplug_every);
  EXPECT_EQ(50, faults.unplug_for);
  EXPECT_TRUE(faults.second_master);
  EXPECT_EQ(7u, faults.seed);
  for (const char* wrong :
       {"", "lost_answers", "lost_answers=", "lost_answers=1.1", "lost_answers=-0.1",
        "lost_answers=nan", "lost_answers=0.1x", "nothing=1", "stall_length=0", "late_by=1.5",
        "second_master=2", "=1"}) {
    EXPECT_THROW(setFault(faults, wrong), std::invalid_argument) << wrong;
  }
  try {
    setFault(faults, "nothing=1");
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string::npos, std::string(error.what()).find("lost_answers"));
  }
}

// The same through the socket.

class Served : public testing::Test {
 protected:
  std::unique_ptr<transport::Transport> connect() const {
    return transport::open(transport::parseDeviceName("virtual:" + path_));
  }

  const TemporaryFolder folder_;
  const std::string path_ = folder_ / "remote.sock";
  const std::unique_ptr<Server> server_ =
      std::make_unique<Server>(path_, "00:1f:32:00:00:01", Device::Options());
};

TEST_F(Served, RemoteGoesAwayAndComesBackByItself) {
  const auto before = connect();
  Faults faults;
  faults.unplug_every = 3;
  faults.unplug_for = 2;
  server_->setFaults(faults);
  for (int i = 0; i < 3; ++i)
    server_->sample(Senses());
  protocol::Report report;
  const auto read_on = [&] {
    for (int i = 0; i < 5; ++i)
      before->read(report, 20.0);
  };
  EXPECT_THROW(read_on(), transport::Disconnected);
  EXPECT_THROW(connect(), transport::NoSuchDevice);
  server_->sample(Senses());
  EXPECT_THROW(connect(), transport::NoSuchDevice);
  server_->sample(Senses());
  EXPECT_EQ("00:1f:32:00:00:01", connect()->remote().identity);
}

TEST_F(Served, GarbageIsNoDataReport) {
  Faults faults;
  faults.garbage = 1.0;
  faults.lost_data = 1.0;
  server_->setFaults(faults);
  for (int i = 0; i < 50; ++i)
    EXPECT_FALSE(server_->sample(Senses()));
}

TEST_F(Served, BatteryNunchukAndMotor) {
  const auto host = connect();
  const auto next = [&] {
    protocol::Report report;
    return host->read(report, 20.0) ? report : protocol::Report();
  };
  server_->setBattery(0x11);
  host->write({0x15, 0x01});
  EXPECT_EQ((protocol::Report{0x20, 0, 0, 0x01, 0, 0, 0x11}), next());
  EXPECT_TRUE(server_->rumble());
  server_->setNunchuk(true);
  EXPECT_EQ((protocol::Report{0x20, 0, 0, 0x03, 0, 0, 0x11}), next());
}

TEST_F(Served, DriverStreamsAgainEachTimeTheRemoteIsBack) {
  Faults faults;
  faults.unplug_every = 100;
  faults.unplug_for = 10;
  faults.second_master = true;
  server_->setFaults(faults);
  std::atomic<bool> stop{false};
  std::thread remote([&] {
    while (!stop) {
      server_->sample(lights({{123, 456, 7, 1}}));
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  });
  wiimote::Wiimote wiimote(
      wiimote::Options(), [this](bool) { return connect(); }, steadyNow);
  const double deadline = steadyNow() + 60.0;
  bool seen = false;
  while (!(seen && wiimote.link().clock_epoch == 2) && steadyNow() < deadline) {
    std::this_thread::sleep_for(std::chrono::duration<double>(wiimote.idleTime()));
    const auto image = wiimote.step(0.05);
    seen = image && image->spots[0].seen;
  }
  EXPECT_EQ(2u, wiimote.link().clock_epoch);
  EXPECT_TRUE(seen);
  stop = true;
  remote.join();
}

}  // namespace
}  // namespace wiimote_tracker::virtual_wiimote
