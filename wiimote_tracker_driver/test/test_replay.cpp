// A recording of the driver's core, played back to it.
#include "contains.h"
#include "recording/reader.h"
#include "refusal_of.h"
#include "replays.h"
#include "waiting.h"
#include "wiimote_tracker_driver/protocol/output_reports.h"
#include "wiimote_tracker_driver/virtual_wiimote/server.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <thread>

namespace wiimote_tracker::recording {
namespace {

TEST_F(Replays, SameImagesAtTheSameTimes) {
  const std::vector<Frame> recorded = recordSimulation(Faults(), 5.0);
  EXPECT_LT(450u, recorded.size());
  Replay replay(path_);
  EXPECT_NEAR(1.7e9, replay.wallTime(), 1e-3);
  EXPECT_EQ(IrFormat::kExtended, replay.irFormat());
  wiimote::Link link;
  expectSame(recorded, 50.0, play(replay, Options(), &link));
  EXPECT_EQ("", replay.notice());
  EXPECT_EQ("00:1f:32:00:00:07", link.remote.identity);
  EXPECT_EQ("wiimote", link.remote.kernel_driver);
  EXPECT_EQ("replay:" + path_, link.remote.description);
  EXPECT_TRUE(link.accelerometer_calibrated);
  EXPECT_FALSE(link.accelerometer_unknown);
  EXPECT_TRUE(replay.statusKnown());
  EXPECT_TRUE(contains(link.error, "has ended")) << link.error;
}

TEST_F(Replays, SameImagesWithAllFaults) {
  Faults faults;
  faults.lost_answers = 0.1;
  faults.lost_data = 0.05;
  faults.late_answers = 0.1;
  faults.duplicated = 0.02;
  faults.truncated = 0.01;
  faults.garbage = 0.01;
  faults.stalls = 0.01;
  faults.unplug_every = 700;
  faults.unplug_for = 180;
  faults.second_master = true;
  for (faults.seed = 1; faults.seed <= 5; ++faults.seed) {
    const std::vector<Frame> recorded = recordSimulation(faults, 30.0);
    EXPECT_LT(500u, recorded.size());
    EXPECT_LT(1u, recorded.back().epoch) << "too few faults";
    Replay replay(path_);
    expectSame(recorded, 50.0, play(replay));
    ::unlink(path_.c_str());
  }
}

// So the exposure clock gives the same stamps.
TEST_F(Replays, ImagesThatWaitedForTheReaderAreKnown) {
  for (const double stop : {0.02, 0.3, 0.7}) {
    const std::vector<Frame> recorded = recordSimulation(Faults(), 10.0, Options(), stop);
    const auto waited = std::count_if(recorded.begin(), recorded.end(),
                                      [](const Frame& frame) { return frame.waited; });
    EXPECT_EQ(waited > 3, stop < 0.6) << "images are dropped after a longer stop";
    Replay replay(path_);
    expectSame(recorded, 50.0, play(replay));
    ::unlink(path_.c_str());
  }
}

TEST_F(Replays, EndsOnce) {
  recordSimulation(Faults(), 1.0);
  Replay replay(path_);
  play(replay);
  for (int i = 0; i < 3; ++i) {
    EXPECT_THROW(replay.open(), transport::NoSuchDevice);
    replay.pass(1.0);
  }
}

TEST_F(Replays, OtherSettingsAreAnsweredAndGetTheRecordedImages) {
  const std::vector<Frame> recorded = recordSimulation(Faults(), 3.0);
  Options options;
  options.leds = 0x8;
  options.sensitivity = *protocol::irSensitivity("wii_1");
  Replay replay(path_);
  expectSame(recorded, 50.0, play(replay, options));
  EXPECT_TRUE(contains(replay.notice(), "sensitivity")) << replay.notice();
  EXPECT_FALSE(contains(replay.notice(), "format")) << replay.notice();
}

// A driver of another version sends other requests, in another order, and at other times.
TEST_F(Replays, RequestsThatWereNotRecordedAreAnswered) {
  recordSimulation(Faults(), 1.0);
  Replay replay(path_);
  const auto transport = replay.open();
  Report answer;
  const auto ask = [&](const Report& request, std::uint8_t id) {
    transport->write(request);
    while (transport->read(answer, 0.5)) {
      if (answer.id() == id)
        return true;
    }
    return false;
  };
  const std::uint8_t secret[] = {0x5e, 0xc2, 0xe7};
  ASSERT_TRUE(ask(protocol::writeMemory(protocol::Space::kRegisters, 0xb00020, secret, 3), 0x22));
  EXPECT_EQ((Report{0x22, 0, 0, 0x16, 0}), answer);
  ASSERT_TRUE(ask(protocol::readMemory(protocol::Space::kRegisters, 0xb00021, 2), 0x21));
  EXPECT_EQ(0x10, answer.bytes[3]);
  EXPECT_EQ(0x21, answer.bytes[5]);
  EXPECT_EQ(0xc2, answer.bytes[6]);
  EXPECT_EQ(0xe7, answer.bytes[7]);
  ASSERT_TRUE(ask(protocol::readMemory(protocol::Space::kEeprom, 0x0018, 2), 0x21));
  EXPECT_EQ(0x86, answer.bytes[6]) << "part of the recorded data";
  EXPECT_EQ(0x30, answer.bytes[7]);
  ASSERT_TRUE(ask(protocol::readMemory(protocol::Space::kEeprom, 0x1000, 20), 0x21));
  EXPECT_EQ(0x08, answer.bytes[3] & 0x0f) << "not known";
  ASSERT_TRUE(ask({0x19, 0x06}, 0x22));
  EXPECT_EQ(0x19, answer.bytes[3]);
  ASSERT_TRUE(ask(protocol::requestStatus(), 0x20));
  EXPECT_EQ(0xa0, answer.bytes[6]);
}

// As recorded but for one value: the host reads back its own write, not the recorded value.
TEST_F(Replays, OwnSettingsAreReadBack) {
  recordSimulation(Faults(), 1.0);
  std::vector<Report> requests;
  {
    std::ifstream in(path_, std::ios::binary);
    Reader reader(in);
    for (Record record; reader.next(record) && record.report.id() != 0x33;) {
      if (record.kind == Record::Kind::kSent)
        requests.push_back(record.report);
    }
  }
  Replay replay(path_);
  const auto transport = replay.open();
  int read_back = 0;
  for (Report request : requests) {
    const bool registers = request.bytes[1] == 0x04 && request.bytes[2] == 0xb0;
    if (request.id() == 0x16 && registers && request.bytes[4] == 0x33)
      request.bytes[6] = 0x01;
    transport->write(request);
    Report answer;
    do {
      ASSERT_TRUE(transport->read(answer, 0.1));
    } while (answer.id() == 0x30);  // the remote's buttons, which it sends until images come
    if (request.id() == 0x17 && registers && request.bytes[4] + request.bytes[6] > 0x33) {
      EXPECT_EQ(0x01, answer.bytes[6u + 0x33u - request.bytes[4]]);
      ++read_back;
    }
  }
  EXPECT_LT(0, read_back);
  EXPECT_TRUE(contains(replay.notice(), "format")) << replay.notice();
}

TEST_F(Replays, TruncatedAnywhereItPlaysUpToThere) {
  recordSimulation(Faults(), 0.5);
  const std::string all = bytes();
  const std::vector<Frame> whole = [&] {
    Replay replay(path_);
    return play(replay);
  }();
  ASSERT_LT(20u, whole.size());
  std::size_t played_most = 0;
  std::size_t unnoticed = 0;
  for (std::size_t size = 0; size < all.size(); ++size) {
    const std::string path = write(all.substr(0, size));
    try {
      Replay replay(path);
      wiimote::Link link;
      const std::vector<Frame> frames = play(replay, Options(), &link);
      ASSERT_LE(played_most, frames.size()) << size;
      played_most = frames.size();
      for (std::size_t i = 0; i < frames.size(); ++i) {
        ASSERT_DOUBLE_EQ(whole[i].arrival, frames[i].arrival);
        ASSERT_TRUE(same(whole[i].image, frames[i].image));
      }
      if (replay.notice().empty()) {
        ++unnoticed;
      } else {
        ASSERT_TRUE(contains(replay.notice(), "cut off")) << replay.notice();
        ASSERT_TRUE(contains(link.error, "has ended: the recording is cut off")) << link.error;
      }
    } catch (const BadRecording& e) {
      ASSERT_TRUE(contains(e.what(), "cut off") || contains(e.what(), "no connection")) << e.what();
      ASSERT_GT(200u, size);
    }
  }
  EXPECT_EQ(whole.size(), played_most);
  // Only a cut between two records, of at least ten bytes each, does not show.
  EXPECT_LE(unnoticed, all.size() / 10);
}

TEST_F(Replays, NoBytesMakeItCrashOrHang) {
  Faults faults;
  faults.unplug_every = 60;
  faults.unplug_for = 30;
  recordSimulation(faults, 2.0);
  const std::string all = bytes();
  std::mt19937 random(11);
  for (int round = 0; round < 1000; ++round) {
    std::string damaged = all;
    for (int i = 0; i < 3; ++i)
      damaged[random() % damaged.size()] = static_cast<char>(random());
    const std::string path = write(damaged);
    try {
      Replay replay(path);
      // A damaged time may leave the remote silent or absent for very long.
      Wiimote wiimote(
          Options(), [&](bool) { return replay.open(); }, [&] { return replay.now(); });
      for (int i = 0; i < 2000 && !replay.ended(); ++i) {
        replay.pass(wiimote.idleTime());
        wiimote.step(0.1);
      }
    } catch (const BadRecording&) {
      // Nothing that could be played is left.
    }
  }
}

TEST_F(Replays, FilesThatCannotBePlayedAreRefusedByName) {
  const auto refusal = [](const std::string& path) -> std::string {
    return refusalOf([&] { Replay replay(path); });
  };
  EXPECT_TRUE(contains(refusal(folder_ / "none.wiirec"), folder_ / "none.wiirec"));
  EXPECT_TRUE(contains(refusal(folder_.path()), folder_.path()));
  EXPECT_TRUE(contains(refusal(write("#ROSBAG V2.0")), "not a recording"));
  { const Recorder recorder(path_, 0.0, 0.0); }
  EXPECT_TRUE(contains(refusal(path_), "no connection"));
}

// As of a recorder that came late: neither status nor EEPROM are known, which is no fault of them.
TEST_F(Replays, WhatWasNotRecordedIsUnknown) {
  {
    Recorder recorder(path_, 0.0, 1.7e9);
    recorder.connected({"00:1f:32:00:00:07", "simulated"}, 0.0);
    for (int i = 1; i < 200; ++i) {
      Report image{0x33, 0, 0, 0x80, 0x80, static_cast<std::uint8_t>(i)};
      image.size = 18;
      recorder.received(image, 0.01 * i);
    }
  }
  wiimote::Link link;
  Replay replay(path_);
  EXPECT_LT(100u, play(replay, Options(), &link).size());
  EXPECT_FALSE(replay.statusKnown());
  EXPECT_FALSE(link.accelerometer_calibrated);
  EXPECT_TRUE(link.accelerometer_unknown);
}

TEST_F(Replays, PaceGetsTheRecordedTimes) {
  const std::vector<Frame> recorded = recordSimulation(Faults(), 1.0);
  std::vector<double> told;
  Replay replay(path_, [&](double time) { told.push_back(time); });
  expectSame(recorded, 50.0, play(replay));
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
  EXPECT_LT(recorded.size(), told.size());
  EXPECT_NEAR(recorded.back().arrival - 50.0, *(told.end() - 1), 0.01);
}

TEST_F(Replays, PlaysInRealTime) {
  const Pace pace = realTime(1000.0);
  const double begin = steadyNow();
  pace(100.0);
  pace(200.0);
  const double duration = steadyNow() - begin;
  EXPECT_LE(0.1, duration);
  EXPECT_GT(20.0, duration) << "100 s at a thousand times the speed";
  EXPECT_THROW(realTime(0.0), std::invalid_argument);
}

/// A clock that stands still between two reports, so that all readers agree on the arrival.
class ArrivalClock : public transport::Transport {
 public:
  ArrivalClock(std::unique_ptr<transport::Transport> transport, std::atomic<double>* now)
      : transport_(std::move(transport)), now_(now) {}
  bool read(Report& report, double timeout) override {
    const bool received = transport_->read(report, timeout);
    *now_ = steadyNow();
    return received;
  }
  void write(const Report& report) override { transport_->write(report); }
  transport::Remote remote() const override { return transport_->remote(); }

 private:
  std::unique_ptr<transport::Transport> transport_;
  std::atomic<double>* now_;
};

// The same over a real socket, in real time, with a remote that goes away in between.
TEST_F(Replays, SocketSession) {
  const std::string socket = folder_ / "remote.sock";
  std::vector<Frame> recorded;
  double begin = 0.0;
  {
    virtual_wiimote::Server server(socket, "00:1f:32:00:00:09", virtual_wiimote::Device::Options());
    std::atomic<bool> stop{false};
    std::thread senses([&] {
      for (int i = 0; !stop; ++i) {
        server.sample(sensesAt(0.01 * i));
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
      }
    });
    std::atomic<double> now{steadyNow()};
    begin = now;
    const auto clock = [&] { return now.load(); };
    const auto recorder = std::make_shared<Recorder>(path_, now, 1.7e9);
    Wiimote wiimote(
        Options(),
        [&](bool) {
          auto remote = transport::open(transport::parseDeviceName("virtual:" + socket));
          return record(std::make_unique<ArrivalClock>(std::move(remote), &now), recorder, clock);
        },
        clock);
    const double deadline = now + 60.0;
    for (const std::size_t enough : {200u, 400u}) {
      while (recorded.size() < enough && now < deadline) {
        if (wiimote.idleTime() > 0.0) {
          std::this_thread::sleep_for(std::chrono::milliseconds(2));
          now = steadyNow();
        } else if (const auto image = wiimote.step(0.1)) {
          recorded.push_back({now, wiimote.link().clock_epoch, wiimote.imageWaited(), *image});
        }
      }
      server.setPresent(false);
      server.setPresent(true);
    }
    stop = true;
    senses.join();
  }
  ASSERT_EQ(400u, recorded.size());
  EXPECT_EQ(1u, recorded.back().epoch);
  Replay replay(path_);
  wiimote::Link link;
  std::vector<Frame> played = play(replay, Options(), &link);
  // A recording answers at once, so that a session may be ready for an image earlier than live.
  const auto was_early = [&](const Frame& frame) {
    const auto first = std::find_if(recorded.begin(), recorded.end(),
                                    [&](const Frame& other) { return other.epoch == frame.epoch; });
    return first != recorded.end() && frame.arrival < first->arrival - begin - 1e-9;
  };
  played.erase(std::remove_if(played.begin(), played.end(), was_early), played.end());
  expectSame(recorded, begin, played);
  EXPECT_EQ("00:1f:32:00:00:09", link.remote.identity);
}

}  // namespace
}  // namespace wiimote_tracker::recording
