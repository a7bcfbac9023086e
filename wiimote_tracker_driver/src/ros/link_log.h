#pragma once

#include "wiimote/wiimote.h"

#include <cstdint>
#include <limits>
#include <optional>
#include <string>

namespace wiimote_tracker::driver {

// Sentences of both the log and the diagnostics.
inline constexpr char kKernelDriverShares[] =
    "the kernel's driver hid-wiimote uses the same remote and may interrupt its images: see "
    "\"Kernel driver\" in doc/quirks.md of wiimote_tracker_driver";

/// What is wrong with the accelerometer's calibration; null when nothing is. Of a streaming remote.
const char* accelerometerProblem(const wiimote::Link& link);

/// Logs changes of the link once, and repeats errors that last. A remote that is off for a night,
/// or reconnects all day, gets ten messages, then one in ten minutes.
class LinkLog {
 public:
  /// `retries`: whether a source that has failed is tried again.
  LinkLog(const std::string& camera, bool retries);

  /// The link has changed. `now` [s]: any clock that never goes back.
  void report(const wiimote::Link& link, double now);

  /// Logs a sentence of the source, once.
  void notice(const std::string& text);

 private:
  /// Whether one more change may be logged.
  bool allows(double now);
  void reportError(const std::string& error, double now);
  void reportRestoration(const wiimote::Link& link, double now);
  void reportStream(const wiimote::Link& link) const;

  const std::string camera_;
  const bool retries_;
  std::optional<std::uint32_t> announced_epoch_;  ///< Of the stream that was logged; nothing: none.
  double allowance_;                              ///< Changes that may be logged at once.
  double allowance_at_ = 0.0;
  std::string error_;  ///< Logged, and not yet followed by a stream.
  double error_logged_at_ = 0.0;
  std::uint64_t restorations_ = 0;  ///< Logged already.
  double restoration_logged_at_ = -std::numeric_limits<double>::infinity();
  std::string notice_;
};

}  // namespace wiimote_tracker::driver
