#include "decisions.h"
#include "honest_remote.h"
#include "invariants.h"
#include "targets.h"

#include "wiimote/wiimote.h"

#include <algorithm>
#include <memory>

namespace wiimote_tracker::fuzz {
namespace {

using protocol::Report;
using virtual_wiimote::Bytes;

// Largest time until a well-behaved remote streams again [s].
constexpr double kWiimoteRecovery = 60.0;
// Turns in which nothing happens and no time passes.
constexpr int kMostIdleTurns = 8;
// Longest error text [characters].
constexpr std::size_t kLongestError = 500;

/// A remote behind a link with the faults that the input chooses.
class HostileWorld {
 public:
  explicit HostileWorld(Decisions& in) : in_(in) {}

  double now = 0.0;
  int events = 0;  ///< Reports that were read, and faults.

  void behave() {
    hostile_ = false;
    remote_.senses = HonestRemote().senses;
    remote_.device.setNunchuk(false);
  }

  std::unique_ptr<transport::Transport> open() {
    remote_.spoken.clear();
    switch (hostile_ ? in_.byte() : 0) {
      case 1:
        throw transport::NoSuchDevice("not there");
      case 2:
        throw transport::PermissionDenied("not allowed");
      case 3:
        throw transport::DeviceTaken("taken");
      default:
        return std::make_unique<Transport>(this);
    }
  }

  bool read(Report& report, double timeout) {
    const double until = now + timeout;
    std::optional<Report> next;
    if (hostile_ && in_.more()) {
      ++events;
      next = hostileRead(until);
    } else {
      next = remote_.next(now, until);
    }
    if (!next)
      return false;
    report = *next;
    ++events;
    return true;
  }

  void write(const Report& report) {
    requireWellFormed(report);
    if (hostile_ && in_.more()) {
      ++events;
      const std::uint8_t fate = in_.byte();
      if (fate == 1)
        throw transport::Disconnected("gone while writing");
      if (fate == 2)
        return;  // lost
    }
    remote_.hear(report, now);
  }

 private:
  struct Transport : transport::Transport {
    explicit Transport(HostileWorld* hostile_world) : world(hostile_world) {}
    bool read(Report& report, double timeout) override { return world->read(report, timeout); }
    void write(const Report& report) override { world->write(report); }
    transport::Remote remote() const override { return {"00:1f:32:00:00:01", "hostile"}; }

    HostileWorld* world;
  };

  std::optional<Report> hostileRead(double until) {
    switch (in_.byte() % 16) {
      case 1:
        throw transport::Disconnected("gone while reading");
      case 2:  // an interrupted wait
        return std::nullopt;
      case 3:  // this computer was suspended
        now = until + in_.byte();
        return std::nullopt;
      case 4:
        return in_.report();
      case 5: {  // one byte differs
        auto report = remote_.next(now, until);
        if (report && report->size > 0)
          report->bytes[in_.byte() % report->size] = in_.byte();
        return report;
      }
      case 6: {  // truncated
        auto report = remote_.next(now, until);
        if (report)
          report->size = std::min<std::size_t>(report->size, in_.byte());
        return report;
      }
      case 7: {  // lost
        remote_.next(now, until);
        return std::nullopt;
      }
      case 8: {  // twice
        auto report = remote_.next(now, until);
        if (report)
          remote_.say(Bytes(report->begin(), report->end()), now);
        return report;
      }
      case 9:
        remote_.device.powerCycle();
        break;
      case 10:  // another master
        secondMaster();
        break;
      case 11:
        if (const auto status = remote_.device.setNunchuk(in_.byte() % 2 == 1))
          remote_.say(*status, now);
        break;
      case 12:
        remote_.senses.lights.clear();
        break;
      case 13:
        remote_.senses = HonestRemote().senses;
        break;
      case 14:  // the link stalls
        for (auto& spoken : remote_.spoken)
          spoken.due += 1e-3 * in_.byte();
        break;
      default:
        break;
    }
    return remote_.next(now, until);
  }

  void secondMaster() {
    static const Report kUsual[] = {
        {0x12, 0x00, 0x30}, {0x13, 0x00}, {0x1a, 0x00}, {0x15, 0x00}, {0x12, 0x04, 0x36}};
    const std::uint8_t what = in_.byte();
    const Report output = what < 5 ? kUsual[what] : in_.report();
    remote_.hear(output, now);
  }

  Decisions& in_;
  bool hostile_ = true;
  HonestRemote remote_;
};

wiimote::Options optionsOf(Decisions& in) {
  wiimote::Options options;
  options.ir_format = in.irFormat();
  options.sensitivity = in.sensitivity();
  return options;
}

/// The driver with that link.
class WiimoteTrial {
 public:
  explicit WiimoteTrial(Decisions& in)
      : in_(in),
        world_(in),
        options_(optionsOf(in)),
        wiimote_(
            options_,
            [this](bool) { return world_.open(); },
            [this] { return world_.now; }) {}

  void run() {
    while (in_.more()) {
      command();
      turn();
    }
    world_.behave();
    const double end = world_.now + kWiimoteRecovery;
    while (!turn())
      require(world_.now < end, "images come again from a remote that behaves");
    require(wiimote_.link().state == wiimote::Link::State::kStreaming, "images mean streaming");
    require(wiimote_.link().error.empty(), "who streams complains no more");
  }

 private:
  /// Requests by users; mostly none.
  void command() {
    switch (in_.byte()) {
      case 1:
        return wiimote_.setSensitivity(in_.sensitivity());
      case 2:
        return wiimote_.setLeds(in_.byte());
      case 3:
        return wiimote_.setRumble(in_.byte() % 2 == 1);
      case 4:
        return wiimote_.close();
      default:
        return;
    }
  }

  /// One turn of the reader thread. @returns whether a light was seen.
  bool turn() {
    const double before = world_.now;
    world_.now += wiimote_.idleTime();
    const int events = world_.events;
    const auto image = wiimote_.step(0.1);
    idle_turns_ = world_.now > before || world_.events > events ? 0 : idle_turns_ + 1;
    require(idle_turns_ <= kMostIdleTurns, "nothing spins while no time passes");
    require(wiimote_.link().error.size() < kLongestError, "errors are one sentence");
    if (!image)
      return false;
    requireImage(*image, options_.ir_format);
    return std::any_of(image->spots.begin(), image->spots.end(),
                       [](const protocol::IrSpot& spot) { return spot.seen; });
  }

  Decisions& in_;
  HostileWorld world_;
  const wiimote::Options options_;
  wiimote::Wiimote wiimote_;
  int idle_turns_ = 0;
};

}  // namespace

void fuzzWiimote(const std::uint8_t* data, std::size_t size) {
  Decisions in(data, size);
  WiimoteTrial(in).run();
}

}  // namespace wiimote_tracker::fuzz
