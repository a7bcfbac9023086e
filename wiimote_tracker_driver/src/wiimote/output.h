#pragma once

#include "wiimote_tracker_driver/protocol/output_reports.h"
#include "wiimote_tracker_driver/protocol/report.h"

#include <functional>
#include <limits>
#include <utility>

namespace wiimote_tracker::wiimote {

/// Sends reports to a remote. Each carries the state of the motor, so reports of other programs
/// stop it. It is therefore repeated while the motor runs.
class Output {
 public:
  /// Sends a report; may throw, and the exception passes through.
  using Write = std::function<void(const protocol::Report&)>;

  explicit Output(Write write) : write_(std::move(write)) {}

  void send(protocol::Report report) {
    if (deadline_ != kNever)
      report.bytes[1] |= protocol::kRumbleBit;
    write_(report);
  }

  void setRumble(bool rumble, double now) {
    deadline_ = rumble ? now + kRumbleInterval : kNever;
    write_(protocol::setRumble(rumble));
  }

  /// Stops the motor with the next report.
  void endRumble() { deadline_ = kNever; }

  void tick(double now) {
    if (now >= deadline_)
      setRumble(true, now);
  }

  /// When tick() is next due [s].
  double deadline() const { return deadline_; }

 private:
  static constexpr double kNever = std::numeric_limits<double>::infinity();
  // How often a running motor is told to run [s].
  static constexpr double kRumbleInterval = 0.1;

  Write write_;
  double deadline_ = kNever;  ///< [s] While the motor runs: when to repeat it.
};

}  // namespace wiimote_tracker::wiimote
