// Recordings of a simulated remote, and their replays.
#pragma once

#include "recording/recorder.h"
#include "recording/replay.h"
#include "temporary_folder.h"
#include "virtual_wiimote/faulty_device.h"
#include "wiimote/wiimote.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <fstream>
#include <iterator>
#include <memory>
#include <random>
#include <string>
#include <vector>

namespace wiimote_tracker::recording {

using protocol::DataReport;
using protocol::IrFormat;
using protocol::Report;
using virtual_wiimote::Bytes;
using virtual_wiimote::Faults;
using virtual_wiimote::FaultyDevice;
using virtual_wiimote::Senses;
using wiimote::Options;
using wiimote::Wiimote;

/// A light on a closed path, so that no two images are equal.
inline Senses sensesAt(double time) {
  Senses senses;
  virtual_wiimote::Light light;
  light.x = 512.0 + 400.0 * std::cos(time);
  light.y = 384.0 + 300.0 * std::sin(3.0 * time);
  senses.lights.push_back(light);
  senses.acceleration = {0.0, std::sin(time), std::cos(time)};
  return senses;
}

/// A virtual remote with all its faults in fake time: samples every 10 ms, and its reports take up
/// to 5 ms.
struct SimulatedRemote {
  explicit SimulatedRemote(const Faults& faults)
      : device(virtual_wiimote::Device::Options(), faults) {}

  double now = 50.0;
  FaultyDevice device;
  std::deque<Bytes> under_way;
  std::mt19937 random{3};

  double next_sample = 50.0;
  double next_arrival = 50.0;

  void take(const std::vector<Bytes>& reports) {
    under_way.insert(under_way.end(), reports.begin(), reports.end());
  }

  void sampleUntil(double time) {
    for (; next_sample <= time; next_sample += 0.01) {
      take(device.sample(sensesAt(next_sample)));
      if (under_way.size() > 64)  // the kernel's queue
        under_way.resize(64);
    }
  }

  bool read(Report& report, double timeout) {
    const double until = now + timeout;
    for (;;) {
      if (device.away())
        throw transport::Disconnected("the remote is out of reach");
      if (!under_way.empty() && next_arrival <= until) {
        now = std::max(now, next_arrival);
        next_arrival = now + 0.001 * (random() % 5000) * 0.001;
        report = Report(under_way.front().data(), under_way.front().size());
        under_way.pop_front();
        return true;
      }
      if (next_sample > until) {
        now = until;
        return false;
      }
      now = std::max(now, next_sample);
      sampleUntil(now);
    }
  }
};

class SimulatedTransport : public transport::Transport {
 public:
  explicit SimulatedTransport(SimulatedRemote* remote) : remote_(remote) {}
  bool read(Report& report, double timeout) override { return remote_->read(report, timeout); }
  void write(const Report& report) override {
    if (remote_->device.away())
      throw transport::Disconnected("the remote is out of reach");
    remote_->take(remote_->device.handleOutput(Bytes(report.begin(), report.end())));
  }
  transport::Remote remote() const override {
    return {"00:1f:32:00:00:07", "simulated", "wiimote"};
  }

 private:
  SimulatedRemote* remote_;
};

struct Frame {
  double arrival;  ///< [s]
  std::uint32_t epoch;
  bool waited;  ///< Perhaps, to be read.
  DataReport image;
};

inline bool same(const DataReport& a, const DataReport& b) {
  const auto same_spot = [](const protocol::IrSpot& p, const protocol::IrSpot& q) {
    return p.seen == q.seen && p.x == q.x && p.y == q.y && p.size == q.size &&
           p.intensity == q.intensity && p.box == q.box;
  };
  return a.id == b.id && a.buttons == b.buttons && a.acceleration == b.acceleration &&
         a.ir_format == b.ir_format &&
         std::equal(a.spots.begin(), a.spots.end(), b.spots.begin(), same_spot);
}

inline void expectSame(const std::vector<Frame>& recorded,
                       double begin,
                       const std::vector<Frame>& played) {
  ASSERT_FALSE(recorded.empty());
  ASSERT_EQ(recorded.size(), played.size());
  for (std::size_t i = 0; i < recorded.size(); ++i) {
    ASSERT_NEAR(recorded[i].arrival - begin, played[i].arrival, 1e-9) << "image " << i;
    ASSERT_TRUE(same(recorded[i].image, played[i].image)) << "image " << i;
    ASSERT_EQ(recorded[i].epoch, played[i].epoch) << "image " << i;
    ASSERT_EQ(recorded[i].waited, played[i].waited) << "image " << i;
  }
}

class Replays : public testing::Test {
 protected:
  /// Lets the driver's core run with a simulated remote and records it. After each 50th image it
  /// does not read for `stop` [s].
  std::vector<Frame> recordSimulation(const Faults& faults,
                                      double duration,
                                      const Options& options = Options(),
                                      double stop = 0.0) const {
    SimulatedRemote remote(faults);
    const auto clock = [&] { return remote.now; };
    auto recorder = std::make_shared<Recorder>(path_, remote.now, 1.7e9);
    const double end = remote.now + duration;
    Wiimote wiimote(
        options,
        [&](bool) -> std::unique_ptr<transport::Transport> {
          if (remote.device.away())
            throw transport::NoSuchDevice("the remote is out of reach");
          remote.under_way.clear();
          return record(std::make_unique<SimulatedTransport>(&remote), recorder, clock);
        },
        clock);
    std::vector<Frame> frames;
    while (remote.now < end) {
      if (const double idle = wiimote.idleTime(); idle > 0.0) {
        remote.now += idle;
        remote.sampleUntil(remote.now);
      }
      const auto image = wiimote.step(0.1);
      if (!image)
        continue;
      frames.push_back({remote.now, wiimote.link().clock_epoch, wiimote.imageWaited(), *image});
      if (frames.size() % 50 == 0) {
        remote.now += stop;
        remote.sampleUntil(remote.now);
      }
    }
    wiimote.close();
    EXPECT_EQ("", recorder->error());
    return frames;
  }

  /// Plays to the driver's core until the recording has ended.
  static std::vector<Frame> play(Replay& replay,
                                 const Options& options = Options(),
                                 wiimote::Link* link = nullptr) {
    Wiimote wiimote(
        options, [&](bool) { return replay.open(); }, [&] { return replay.now(); });
    std::vector<Frame> frames;
    while (!replay.ended()) {
      if (const double idle = wiimote.idleTime(); idle > 0.0)
        replay.pass(idle);
      if (const auto image = wiimote.step(0.1))
        frames.push_back({replay.now(), wiimote.link().clock_epoch, wiimote.imageWaited(), *image});
    }
    if (link != nullptr)
      *link = wiimote.link();
    return frames;
  }

  std::string bytes() const {
    std::ifstream in(path_, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  }

  /// Another file with these bytes.
  std::string write(const std::string& bytes) const {
    const std::string path = folder_ / "b.wiirec";
    ::unlink(path.c_str());  // some file systems write through when a file is replaced
    std::ofstream(path, std::ios::binary) << bytes;
    return path;
  }

  const TemporaryFolder folder_;
  const std::string path_ = folder_ / "a.wiirec";
};

}  // namespace wiimote_tracker::recording
