#pragma once

#include "wiimote_tracker_driver/protocol/report.h"
#include "wiimote_tracker_driver/virtual_wiimote/device.h"

#include <deque>
#include <optional>

namespace wiimote_tracker::fuzz {

/// A virtual remote in fake time: answers after 5 ms and samples every 10 ms. All members are
/// public, so that the input may change its state and its reports.
struct HonestRemote {
  static constexpr double kAnswerDelay = 0.005;  // [s]
  static constexpr double kPeriod = 0.01;        // [s]
  static constexpr std::size_t kQueue = 64;      // like the kernel's

  struct Spoken {
    double due;  // [s]
    virtual_wiimote::Bytes bytes;
  };

  virtual_wiimote::Device device;
  virtual_wiimote::Senses senses;
  std::deque<Spoken> spoken;
  double next_sample = 0.0;  // [s]

  HonestRemote();

  void hear(const protocol::Report& output, double now);
  void say(const virtual_wiimote::Bytes& bytes, double due);

  /// The next report before `until`; sets `now` to its time, or to `until`.
  std::optional<protocol::Report> next(double& now, double until);
};

}  // namespace wiimote_tracker::fuzz
