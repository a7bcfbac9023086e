#ifndef WIIMOTE_TRACKER_DRIVER_SIMULATED_LINK_H
#define WIIMOTE_TRACKER_DRIVER_SIMULATED_LINK_H

#include <cstdint>
#include <string>
#include <vector>

namespace wiimote_tracker::exposure_clock {

/// How a simulated camera's reports come to be late. Times in s.
struct LinkModel {
  enum class Core {
    kHardEdge,  ///< least delay + exponential of mean `spread`
    kBell       ///< least delay + 3.4 spread + normal of standard deviation `spread`
  };
  Core core = Core::kHardEdge;
  double spread = 0.005;
  double least_delay = 0.006;
  /// Standard deviation of the clock's random walk over 10 s.
  double wander = 0.0;
  /// Reports leave the device at the slots of the radio link [s]; 0: at any time.
  double slot = 0.0;
  /// Share of lost frames; each loss takes the next frame along with probability `burst`.
  double drops = 0.05;
  double burst = 0.2;
  /// Stalls per second; each holds all reports for up to `longest_stall`.
  double stalls = 0.0;
  double longest_stall = 0.160;
};

struct SimulatedReport {
  std::int64_t frame;
  double exposure;
  double arrival;
  /// Waited for an earlier report or for the end of a stall: the arrival says little.
  bool queued;
};

struct SimulatedSession {
  double period;  ///< true period [s]
  std::vector<SimulatedReport> reports;
};

/// Reports of `duration` seconds, period 10.035 ms +- 500 ppm (uniform), by fixed seed.
SimulatedSession simulate(const LinkModel& link, double duration, std::uint64_t seed);

}  // namespace wiimote_tracker::exposure_clock

#endif
