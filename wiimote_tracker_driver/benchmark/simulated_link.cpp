#include "simulated_link.h"

namespace wiimote_tracker::exposure_clock {

LinkModel::LinkModel() {
  phase = 100.0;
  delay = 0.006;
  jitter = 0.005;
  period_tolerance = 500e-6;
  drops = 0.05;
  burst = 0.2;
}

SimulatedSession simulate(const LinkModel& link, double duration, std::uint64_t seed) {
  virtual_wiimote::FrameTimes times(link, seed);
  SimulatedSession session;
  session.period = times.period();
  const auto frames = static_cast<std::int64_t>(duration / session.period);
  for (std::int64_t frame = 0; frame < frames; ++frame) {
    const virtual_wiimote::FrameTime time = times.next();
    if (!time.lost)
      session.reports.push_back(time);
  }
  return session;
}

}  // namespace wiimote_tracker::exposure_clock
