#pragma once

#include "transport/transport.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace wiimote_tracker::wiimote {

/// A remote in fake time, in raw bytes: answers requests after 5 ms and sends an infrared report
/// every 10 ms in modes 0x33, 0x37 and 0x3e. Tests remove, add and change its reports. It allocates
/// nothing per report once it has seen all of a kind, unless it `remembers`.
class FakeRemote {
 public:
  using Report = protocol::Report;

  struct Written {
    double time;
    Report report;
  };

  double now = 100.0;
  double period = 0.01;         ///< [s] Of the camera's clock, which runs on without reports.
  std::uint8_t battery = 0x8f;  ///< Raw level.
  bool present = true;
  bool answers = true;
  /// Called for each output report; true: the remote does not get it.
  std::function<bool(const Report&)> lose = [](const Report&) { return false; };
  std::array<std::uint8_t, 10> block{{0x84, 0x82, 0x86, 0x30, 0x9f, 0x9d, 0x9f, 0x02, 0x40, 0x2e}};
  std::array<std::uint8_t, 10> copy = block;
  // Points (136, 645), (907, 650), (919, 63), (140, 57).
  std::array<std::uint8_t, 11> ir_block{
      {0x88, 0x85, 0x8b, 0x8b, 0x8a, 0x97, 0x3f, 0x30, 0x8c, 0x39, 0xcd}};
  std::array<std::uint8_t, 11> ir_copy = ir_block;
  std::set<std::uint8_t> unacknowledged;  ///< Output reports that it obeys without a word.
  bool light = true;
  bool registers_readable = true;
  bool echoes = true;  ///< Sends its present data at once when a mode is set.

  bool remembers = true;  ///< Keeps all output reports.
  std::vector<Written> written;
  int opened = 0;
  std::uint64_t sent = 0;  ///< Images or halves, without echoes.

  // State that others may change without the driver.
  std::uint8_t mode = 0x30;
  bool camera = false;  ///< 0x13
  bool logic = false;   ///< 0x1a
  std::map<int, std::uint8_t> registers;
  std::uint8_t leds = 0;
  bool rumble = false;

  std::unique_ptr<transport::Transport> open();

  void powerCycle() {
    mode = 0x30;
    camera = false;
    logic = false;
    registers.clear();
    leds = 0;
    rumble = false;
  }

  /// Sends this `delay` seconds from now.
  void say(const Report& report, double delay = 0.0) {
    const double due = now + delay;
    const auto after =
        std::upper_bound(pending_.begin(), pending_.end(), due,
                         [](double time, const Written& other) { return time < other.time; });
    pending_.insert(after, {due, report});
  }

  int count(const Report& report) const {
    return static_cast<int>(std::count_if(written.begin(), written.end(),
                                          [&](const Written& w) { return w.report == report; }));
  }

  bool take(Report& report, double timeout) {
    if (!present)
      throw transport::Disconnected("the fake remote has gone");
    const double end = now + timeout;
    const bool image_due = sendsImages() && next_image_ <= end;
    const bool answer_due = !pending_.empty() && pending_.front().time <= end;
    if (answer_due && !(image_due && next_image_ < pending_.front().time)) {
      now = std::max(now, pending_.front().time);
      report = pending_.front().report;
      pending_.erase(pending_.begin());
      return true;
    }
    if (image_due) {
      now = std::max(now, next_image_);
      next_image_ = nextExposure();
      ++sent;
      report = image();
      return true;
    }
    now = end;
    return false;
  }

  void receive(const Report& report) {
    if (!present)
      throw transport::Disconnected("the fake remote has gone");
    if (remembers)
      written.push_back({now, report});
    if (!answers || lose(report))
      return;
    const auto& b = report.bytes;
    const int address = b[3] << 8 | b[4];
    rumble = (b[1] & 1) != 0;
    switch (b[0]) {
      case 0x15:
        say({0x20, 0, 0,
             static_cast<std::uint8_t>(leds << 4 | (camera ? 8 : 0) | (battery < 0x20 ? 1 : 0)), 0,
             0, battery},
            kDelay);
        return;
      case 0x16: {
        const bool good = (b[1] & 4) != 0 && b[2] == 0xb0 && camera;
        for (int i = 0; good && i < b[5]; ++i)
          registers[address + i] = b[6 + static_cast<std::size_t>(i)];
        say({0x22, 0, 0, 0x16, static_cast<std::uint8_t>(good ? 0 : 7)}, kDelay);
        return;
      }
      case 0x17:
        say(memory((b[1] & 4) != 0, address, b[6]), kDelay);
        return;
      case 0x11:
        leds = b[1] >> 4;
        break;
      case 0x12:
        if (!sendsImages())
          next_image_ = nextExposure();
        mode = b[2];
        break;
      case 0x13:
        camera = (b[1] & 4) != 0;
        break;
      case 0x1a:
        logic = (b[1] & 4) != 0;
        break;
      default:
        break;
    }
    if ((b[1] & 2) && unacknowledged.count(b[0]) == 0)
      say({0x22, 0, 0, b[0], 0}, kDelay);
    if (b[0] == 0x12 && sendsImages() && echoes)
      say(image(), kDelay);  // its present data, at once
  }

 private:
  static constexpr double kDelay = 0.005;

  double nextExposure() const { return period * (std::floor(now / period + 1e-3) + 1.0); }

  bool sendsImages() const { return mode == 0x33 || mode == 0x37 || mode == 0x3e; }

  /// One light at (291, 69), of size 3 where the format has sizes.
  Report image() {
    const bool sees = light && camera && logic && registers[0x30] == 8;
    const auto ir = [&](Report& report, std::size_t at, int format,
                        std::initializer_list<std::uint8_t> bytes) {
      std::fill(report.bytes.begin() + static_cast<std::ptrdiff_t>(at), report.bytes.end(), 0xff);
      if (sees && registers[0x33] == format)
        std::copy(bytes.begin(), bytes.end(),
                  report.bytes.begin() + static_cast<std::ptrdiff_t>(at));
    };
    // No two samples of a real accelerometer are the same.
    Report report{mode, 0, 0, 0x80, 0x80, static_cast<std::uint8_t>(0x80 | (sent & 1))};
    if (mode == 0x3e) {
      second_half_ = !second_half_;
      report.bytes[0] = second_half_ ? 0x3f : 0x3e;
      report.size = 22;
      if (second_half_)
        ir(report, 4, 5, {});
      else
        ir(report, 4, 5, {0x23, 0x45, 0x13, 35, 7, 37, 9, 0, 200});
    } else if (mode == 0x37) {
      report.size = 22;
      ir(report, 6, 1, {0x23, 0x45, 0x1f});
    } else {
      report.size = 18;
      ir(report, 6, 3, {0x23, 0x45, 0x13});
    }
    return report;
  }

  Report memory(bool register_space, int address, int size) {
    Report report{0x21,
                  0,
                  0,
                  static_cast<std::uint8_t>((size - 1) << 4),
                  static_cast<std::uint8_t>(address >> 8),
                  static_cast<std::uint8_t>(address)};
    report.size = 22;
    if (register_space && !(camera && registers_readable)) {
      report.bytes[3] = 0xf7;
    } else if (register_space) {
      for (int i = 0; i < size; ++i)
        report.bytes[6 + static_cast<std::size_t>(i)] = registers[address + i];
    } else {
      const auto answer = [&](const auto& source) {
        std::copy(source.begin(), source.end(), report.bytes.begin() + 6);
      };
      if (address < 0x16)
        answer(address == 0 ? ir_block : ir_copy);
      else
        answer(address == 0x16 ? block : copy);
    }
    return report;
  }

  std::vector<Written> pending_;
  double next_image_ = 0.0;
  bool second_half_ = true;  ///< The last half sent was the second.
};

class FakeTransport : public transport::Transport {
 public:
  explicit FakeTransport(FakeRemote* remote) : remote_(remote) {}
  bool read(protocol::Report& report, double timeout) override {
    return remote_->take(report, timeout);
  }
  void write(const protocol::Report& report) override { remote_->receive(report); }
  transport::Remote remote() const override { return {"00:1f:32:00:00:01", "fake"}; }

 private:
  FakeRemote* remote_;
};

inline std::unique_ptr<transport::Transport> FakeRemote::open() {
  if (!present)
    throw transport::NoSuchDevice("no fake remote is connected");
  ++opened;
  return std::make_unique<FakeTransport>(this);
}

}  // namespace wiimote_tracker::wiimote
