#include "decisions.h"
#include "honest_remote.h"
#include "invariants.h"
#include "targets.h"

#include "wiimote/session.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace wiimote_tracker::fuzz {
namespace {

using protocol::Report;
using wiimote::Session;

// Largest time until a well-behaved remote streams again [s]: the watchdog's longest interval in
// darkness, and failed attempts.
constexpr double kRecovery = 60.0;
// Larger than the number of reports that the driver ever sends for one event.
constexpr int kMostWrites = 6;
// Deadlines that can fall due in one instant.
constexpr int kMostTicks = 4;

/// A session in fake time, restarted whenever it gives up its remote.
class Trial {
 public:
  explicit Trial(Decisions& in) : in_(in) {
    options_.ir_format = in.irFormat();
    begin();
  }

  void run() {
    while (in_.more())
      event(in_.byte());
    recover();
  }

 private:
  void begin() {
    writes_ = 0;
    session_.emplace(
        options_, [this](const Report& report) { written(report); }, now_);
  }

  void written(const Report& report) {
    requireWellFormed(report);
    require(++writes_ <= kMostWrites, "an event has few answers");
    asked_ = report;
    for (std::size_t i = 0; report.id() == 0x16 && i < report.bytes[5]; ++i)
      registers_[(report.bytes[4] + i) % registers_.size()] = report.bytes[6 + i];
    if (remote_)
      remote_->hear(report, now_);
  }

  /// One call of the session.
  template <typename Call>
  void act(Call call) {
    writes_ = 0;
    try {
      call();
    } catch (const wiimote::SessionError&) {
      begin();
    }
  }

  /// Handles due deadlines; afterwards none is due.
  void tick() {
    for (int i = 0; i < kMostTicks && session_->deadline() <= now_; ++i)
      act([this] { session_->tick(now_); });
    require(std::isfinite(session_->deadline()), "there is a next deadline");
    require(session_->deadline() > now_, "no deadline stays due");
  }

  /// @returns whether it is an image with a light.
  bool hear(const Report& report) {
    bool light = false;
    act([&] {
      if (const auto image = session_->handle(report, now_)) {
        requireImage(*image, options_.ir_format);
        require(session_->streaming(), "images come while streaming");
        light = std::any_of(image->spots.begin(), image->spots.end(),
                            [](const protocol::IrSpot& spot) { return spot.seen; });
      }
    });
    tick();
    return light;
  }

  void acknowledge(std::uint8_t error) { hear({0x22, 0, 0, asked_.id(), error}); }

  void memory(std::uint8_t size_and_error, bool right_address) {
    Report report{0x21, 0, 0, size_and_error, asked_.bytes[3], asked_.bytes[4]};
    report.size = Report::kCapacity;
    if (!right_address)
      report.bytes[5] = static_cast<std::uint8_t>(report.bytes[5] + 1);
    for (std::size_t i = 6; i < report.size; ++i)
      report.bytes[i] = in_.byte();
    hear(report);
  }

  /// The answer of a camera that stored all writes.
  void memoryAsWritten() {
    const std::uint8_t size = asked_.bytes[6] % 17;
    Report report{0x21,           0, 0, static_cast<std::uint8_t>(16 * size - 16), asked_.bytes[3],
                  asked_.bytes[4]};
    report.size = Report::kCapacity;
    for (std::size_t i = 0; i < size; ++i)
      report.bytes[6 + i] = registers_[(asked_.bytes[4] + i) % registers_.size()];
    hear(report);
  }

  void image(std::uint8_t id) {
    Report report;
    report.size = Report::kCapacity;
    const std::uint8_t fill = in_.byte();
    report.bytes.fill(fill);
    report.bytes[0] = id;
    hear(report);
  }

  void imageAsConfigured() {
    if (options_.ir_format == protocol::IrFormat::kFull) {
      image(0x3e);
      image(0x3f);
    } else {
      image(options_.ir_format == protocol::IrFormat::kBasic ? 0x37 : 0x33);
    }
  }

  void event(std::uint8_t kind) {
    switch (kind % 16) {
      case 0:
        now_ += 1e-3 * in_.byte();
        return tick();
      case 1:
        now_ = std::max(now_, session_->deadline());
        return tick();
      case 2:
        now_ += in_.byte();
        return tick();
      case 3:
        hear(in_.report());
        return;
      case 4:
        return acknowledge(0);
      case 5:
        return acknowledge(in_.byte());
      case 6:
        return memory(in_.byte(), true);
      case 7:
        return memory(in_.byte(), false);
      case 8:
        return memoryAsWritten();
      case 9:
        return imageAsConfigured();
      case 10:
        return image(static_cast<std::uint8_t>(0x30 + in_.byte() % 16));
      case 11:
        hear({0x20, 0, 0, in_.byte(), 0, 0, in_.byte()});
        return;
      case 12:
        options_.sensitivity = in_.sensitivity();
        act([this] { session_->setSensitivity(options_.sensitivity, now_); });
        return tick();
      case 13:
        act([this] { session_->setLeds(in_.byte()); });
        return tick();
      case 14:
        act([this] { session_->setRumble(in_.byte() % 2 == 1, now_); });
        return tick();
      default:
        act([this] { session_->switchOff(); });
    }
  }

  /// From now on the input has no effect: a remote that was just switched on works correctly.
  void recover() {
    remote_.emplace();
    remote_->next_sample = now_;
    const double end = now_ + kRecovery;
    while (now_ < end) {
      const auto report = remote_->next(now_, std::min(session_->deadline(), end));
      if (report && hear(*report))
        return;
      tick();
    }
    throw Broken("images come again from a remote that behaves");
  }

  Decisions& in_;
  wiimote::Options options_;
  std::array<std::uint8_t, 256> registers_{};
  double now_ = 0.0;
  int writes_ = 0;
  Report asked_;
  std::optional<Session> session_;
  std::optional<HonestRemote> remote_;
};

}  // namespace

void fuzzSession(const std::uint8_t* data, std::size_t size) {
  Decisions in(data, size);
  Trial(in).run();
}

}  // namespace wiimote_tracker::fuzz
