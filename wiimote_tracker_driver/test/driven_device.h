#pragma once

#include "virtual_wiimote/faulty_device.h"
#include "wiimote/wiimote.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <memory>
#include <utility>

namespace wiimote_tracker::wiimote {

constexpr double kPeriod = 0.01;    // [s]
constexpr double kLatency = 0.012;  // [s] Of output reports; input reports arrive at once.

/// A virtual remote that samples every 10 ms of fake time, and its view. The kernel's driver may
/// share it.
struct Remote {
  explicit Remote(const virtual_wiimote::Faults& faults = {},
                  const virtual_wiimote::Device::Options& options = {})
      : device(options, faults) {}

  void at(double time) {
    while (!said.empty() && said.front().first <= time) {
      for (const virtual_wiimote::Bytes& answer : device.handleOutput(said.front().second))
        heard.push_back(answer);
      said.pop_front();
    }
  }

  /// Advances the time until there is a report, at most until `end`.
  void passUntil(double end) {
    while (heard.empty()) {
      const double next = std::min(next_sample, said.empty() ? end : said.front().first);
      if (next > end)
        break;
      now = std::max(now, next);
      at(now);
      if (now >= next_sample) {
        next_sample += kPeriod;
        for (const virtual_wiimote::Bytes& report : device.sample(senses))
          heard.push_back(report);
      }
      if (next >= end)
        break;
    }
    if (heard.empty())
      now = std::max(now, end);
  }

  virtual_wiimote::FaultyDevice device;
  virtual_wiimote::Senses senses;
  double now = 0.0;
  double next_sample = kPeriod;
  std::deque<std::pair<double, virtual_wiimote::Bytes>> said;
  std::deque<virtual_wiimote::Bytes> heard;
};

class RemoteTransport : public transport::Transport {
 public:
  explicit RemoteTransport(Remote* remote) : remote_(remote) {}

  bool read(protocol::Report& report, double timeout) override {
    remote_->passUntil(remote_->now + timeout);
    if (remote_->heard.empty())
      return false;
    report = {remote_->heard.front().data(), remote_->heard.front().size()};
    remote_->heard.pop_front();
    return true;
  }
  void write(const protocol::Report& report) override {
    remote_->said.emplace_back(remote_->now + kLatency,
                               virtual_wiimote::Bytes(report.begin(), report.end()));
  }
  transport::Remote remote() const override { return {"", "device"}; }

 private:
  Remote* remote_;
};

/// A driver of such a remote.
struct Driven {
  explicit Driven(const Options& options = Options(),
                  const virtual_wiimote::Faults& faults = {},
                  const virtual_wiimote::Device::Options& device = {})
      : remote(faults, device),
        wiimote(
            options,
            [this](bool) { return std::make_unique<RemoteTransport>(&remote); },
            [this] { return remote.now; }) {}

  /// Advances the time. @returns the number of images that show a light.
  int run(double duration) {
    int lit = 0;
    for (const double end = remote.now + duration; remote.now < end;) {
      const auto image = wiimote.step(end - remote.now);
      if (!image)
        continue;
      last = *image;
      missing += std::max(0, static_cast<int>(std::lround((remote.now - arrival) / kPeriod)) - 1);
      arrival = remote.now;
      lit += std::any_of(last.spots.begin(), last.spots.end(),
                         [](const protocol::IrSpot& spot) { return spot.seen; });
    }
    return lit;
  }

  /// Runs until an image shows a light. @returns whether one has come within 5 s.
  bool runToLight() {
    for (const double end = remote.now + 5.0; remote.now < end;) {
      if (run(kPeriod) > 0)
        return true;
    }
    return false;
  }

  Remote remote;
  Wiimote wiimote;
  protocol::DataReport last;
  double arrival = 0.0;  ///< Of the last image [s].
  int missing = 0;       ///< Periods of the remote without an image.
};

}  // namespace wiimote_tracker::wiimote
