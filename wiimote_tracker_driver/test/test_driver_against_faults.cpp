// The driver's recovery from each fault of a remote, in fake time.
#include "virtual_remote_bytes.h"
#include "virtual_wiimote/faulty_device.h"
#include "wiimote/wiimote.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <memory>
#include <ostream>
#include <vector>

namespace wiimote_tracker::virtual_wiimote {
namespace {

/// A remote and its faults as a transport without a socket: a sample every 10 ms.
class FaultyTransport : public transport::Transport {
 public:
  FaultyTransport(FaultyDevice* device, const Senses* senses, double* now)
      : device_(device), senses_(senses), now_(now) {}

  bool read(protocol::Report& report, double timeout) override {
    if (arrived_.empty()) {
      if (timeout < 0.01) {
        *now_ += timeout;
        return false;
      }
      *now_ += 0.01;
      add(device_->sample(*senses_));
      if (device_->away())
        throw transport::Disconnected("the remote has gone");
    }
    if (arrived_.empty())
      return false;
    report = protocol::Report(arrived_.front().data(), arrived_.front().size());
    arrived_.pop_front();
    return true;
  }
  void write(const protocol::Report& report) override {
    add(device_->handleOutput(Bytes(report.begin(), report.end())));
  }
  transport::Remote remote() const override { return {"", "device"}; }

 private:
  void add(const std::vector<Bytes>& reports) {
    arrived_.insert(arrived_.end(), reports.begin(), reports.end());
  }

  FaultyDevice* device_;
  const Senses* senses_;
  double* now_;
  std::deque<Bytes> arrived_;
};

struct Case {
  const char* name;
  std::vector<const char*> faults;
  int images;      ///< Least number per minute, of 6000 samples.
  double longest;  ///< Longest gap [s].
};

std::ostream& operator<<(std::ostream& out, const Case& c) {
  return out << c.name;
}

class DriverAgainst : public testing::TestWithParam<Case> {};

TEST_P(DriverAgainst, ImagesComeBack) {
  Faults faults;
  for (const char* fault : GetParam().faults)
    setFault(faults, fault);
  FaultyDevice device(Device::Options(), faults);
  const Senses senses = lights({{123, 456, 7, 1}});
  double now = 0.0;
  wiimote::Wiimote wiimote(
      wiimote::Options(),
      [&](bool) -> std::unique_ptr<transport::Transport> {
        if (device.away())
          throw transport::NoSuchDevice("there is no remote");
        return std::make_unique<FaultyTransport>(&device, &senses, &now);
      },
      [&] { return now; });

  int images = 0;
  double last = 0.0;
  double longest = 0.0;
  while (now < 60.0) {
    const double idle = wiimote.idleTime();
    for (double passed = 0.0; passed < idle; passed += 0.01) {
      device.sample(senses);
      now += 0.01;
    }
    const auto image = wiimote.step(0.05);
    if (!image || !image->spots[0].seen)
      continue;
    ASSERT_EQ(123, image->spots[0].x);
    ASSERT_EQ(456, image->spots[0].y);
    ++images;
    longest = std::max(longest, now - last);
    last = now;
  }
  longest = std::max(longest, now - last);
  EXPECT_GE(images, GetParam().images);
  EXPECT_LE(longest, GetParam().longest);
}

INSTANTIATE_TEST_SUITE_P(
    EachFault,
    DriverAgainst,
    testing::Values(Case{"none", {}, 5900, 0.1},
                    Case{"lost_answers", {"lost_answers=0.3"}, 5000, 5.0},
                    Case{"late_answers", {"late_answers=0.5"}, 5000, 5.0},
                    Case{"lost_data", {"lost_data=0.05"}, 5500, 0.2},
                    Case{"duplicated", {"duplicated=0.5"}, 5900, 0.1},
                    Case{"truncated", {"truncated=0.2"}, 4000, 3.0},
                    Case{"garbage", {"garbage=0.2"}, 5900, 0.6},
                    Case{"stalls", {"stalls=0.02", "stall_length=16"}, 5700, 0.6},
                    Case{"unplug", {"unplug_every=700", "unplug_for=150"}, 4300, 2.5},
                    Case{"second_master", {"second_master=1"}, 5500, 1.0},
                    Case{"all",
                         {"lost_answers=0.05", "late_answers=0.05", "lost_data=0.04",
                          "duplicated=0.02", "truncated=0.02", "garbage=0.02", "stalls=0.005",
                          "unplug_every=2000", "second_master=1"},
                         4000,
                         4.0}),
    [](const testing::TestParamInfo<Case>& info) { return info.param.name; });

}  // namespace
}  // namespace wiimote_tracker::virtual_wiimote
