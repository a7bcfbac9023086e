#ifndef WIIMOTE_TRACKER_DRIVER_BENCHMARK_STEADY_REMOTE_H
#define WIIMOTE_TRACKER_DRIVER_BENCHMARK_STEADY_REMOTE_H

#include "transport/transport.h"
#include "wiimote_tracker_driver/protocol/report.h"

#include <array>
#include <cstdint>
#include <memory>

namespace wiimote_tracker::wiimote {

/// A remote in fake time at almost no cost: obeys at once, sends a data report every period in
/// modes 0x33, 0x37 and 0x3e, with one moving light, and allocates nothing. For measuring the
/// driver, not for testing it: it checks nothing.
class SteadyRemote {
 public:
  double now = 0.0;             ///< [s]
  std::uint64_t sent = 0;       ///< Data reports.
  std::uint8_t battery = 0x60;  ///< Raw level, for the next status.

  std::unique_ptr<transport::Transport> open();

  /// Another program stops the data reports.
  void loseMode() { mode_ = 0; }

  /// Resets the remote as after switching on.
  void powerCycle();

  /// The next read fails, and so does open() until `until` [s].
  void disconnect(double until = 0.0) {
    connected_ = false;
    away_until_ = until;
  }

 private:
  class Transport;
  static constexpr double kPeriod = 0.010035;  // [s] as real ones have about

  bool read(protocol::Report& report, double timeout);
  void write(const protocol::Report& output);
  void say(const protocol::Report& answer);
  protocol::Report memory(const protocol::Report& request) const;
  protocol::Report data();
  /// The camera's next exposure; its clock runs on without reports [s].
  double afterNow() const;

  bool connected_ = true;
  double away_until_ = 0.0;  // [s]
  std::uint8_t mode_ = 0;
  std::array<std::uint8_t, 256> registers_{};
  std::array<protocol::Report, 16> answers_{};  // a ring
  std::size_t first_answer_ = 0;
  std::size_t answers_waiting_ = 0;
  double next_data_ = 0.0;
};

}  // namespace wiimote_tracker::wiimote

#endif  // WIIMOTE_TRACKER_DRIVER_BENCHMARK_STEADY_REMOTE_H
