#pragma once

#include "wiimote_tracker_driver/virtual_wiimote/frame_times.h"

#include <cstdint>
#include <vector>

namespace wiimote_tracker::exposure_clock {

/// A Wii Remote's clock and link: period 10.035 ms +- 500 ppm, 5 % of the frames lost.
struct LinkModel : virtual_wiimote::FrameTimesModel {
  LinkModel() {
    phase = 100.0;
    delay = 0.006;
    jitter = 0.005;
    period_tolerance = 500e-6;
    drops = 0.05;
    burst = 0.2;
  }
};

struct SimulatedSession {
  double period;                                    ///< true period [s]
  std::vector<virtual_wiimote::FrameTime> reports;  ///< of frames that were not lost
};

/// Frames of `duration` seconds, by fixed seed.
inline SimulatedSession simulate(const LinkModel& link, double duration, std::uint64_t seed) {
  virtual_wiimote::FrameTimes times(link, seed);
  SimulatedSession session{times.period(), {}};
  for (auto frames = static_cast<std::int64_t>(duration / session.period); frames > 0; --frames) {
    const virtual_wiimote::FrameTime time = times.next();
    if (!time.lost)
      session.reports.push_back(time);
  }
  return session;
}

}  // namespace wiimote_tracker::exposure_clock
