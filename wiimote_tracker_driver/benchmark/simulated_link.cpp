#include "simulated_link.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace wiimote_tracker::exposure_clock {

namespace {
constexpr double kNominalPeriod = 0.010035;
constexpr double kPeriodTolerance = 500e-6;
constexpr double kWanderTime = 10.0;
// Two reports do not leave in less than this [s].
constexpr double kServiceTime = 0.3e-3;
}  // namespace

SimulatedSession simulate(const LinkModel& link, double duration, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::normal_distribution<double> normal(0.0, 1.0);
  std::exponential_distribution<double> exponential(1.0);

  SimulatedSession session;
  session.period = kNominalPeriod * (1.0 + kPeriodTolerance * (2.0 * uniform(random) - 1.0));
  const double step = link.wander * std::sqrt(session.period / kWanderTime);
  const double slot_phase = uniform(random) * link.slot;
  double phase = 100.0 + uniform(random);
  double previous = 0.0;
  double stall_end = 0.0;
  bool dropping = false;
  const auto frames = static_cast<std::int64_t>(duration / session.period);
  // Mean run of losses is 1 / (1 - burst).
  const double start_drop = link.drops * (1.0 - link.burst) / (1.0 - link.drops);
  for (std::int64_t frame = 0; frame < frames; ++frame, phase += step * normal(random)) {
    const double exposure = phase + static_cast<double>(frame) * session.period;
    double delay = link.core == LinkModel::Core::kHardEdge
                       ? link.spread * exponential(random)
                       : std::max(0.0, link.spread * (3.4 + normal(random)));
    delay += link.least_delay;
    const bool stall = uniform(random) < link.stalls * session.period;
    const double stall_length = link.longest_stall * uniform(random);
    dropping = uniform(random) < (dropping ? link.burst : start_drop);
    if (stall)
      stall_end = std::max(stall_end, exposure + delay + stall_length);
    if (dropping)
      continue;
    const double ready = exposure + delay;
    double arrival = std::max({ready, previous + kServiceTime, stall_end});
    const bool queued = arrival > ready;
    if (link.slot > 0.0)
      arrival = slot_phase + link.slot * std::ceil((arrival - slot_phase) / link.slot);
    previous = arrival;
    session.reports.push_back({frame, exposure, arrival, queued});
  }
  return session;
}

}  // namespace wiimote_tracker::exposure_clock
