// Exposure times from arrival times: our clock and others, for every model of the link.
#include "timing_trial.h"

#include <wiimote_tracker_msgs/benchmark_tables.h>

#include <cstdint>
#include <functional>
#include <limits>
#include <string>

using namespace wiimote_tracker;
using namespace wiimote_tracker::exposure_clock;

namespace {
/// Every link of the table, with its name.
void forLinks(const std::function<void(const std::string& name, const LinkModel& link)>& run) {
  using Core = LinkModel::Core;
  const auto add = [&](Core core, double spread, double wander, double slot, double stalls) {
    LinkModel link;
    link.core = core;
    link.jitter = spread;
    link.wander = wander;
    link.slot = slot;
    link.stalls = stalls;
    run(format("%s %g, wander %g%s%s", core == Core::kExponential ? "exponential" : "normal",
               spread * 1e3, wander * 1e3, slot > 0.0 ? ", slots" : "",
               stalls > 0.0 ? ", stalls" : ""),
        link);
  };
  for (double spread : {2e-3, 5e-3, 10e-3})
    for (double wander : {0.0, 0.3e-3, 1e-3})
      add(Core::kExponential, spread, wander, 0.0, 0.0);
  for (double wander : {0.0, 1e-3})
    add(Core::kExponential, 5e-3, wander, 1.25e-3, 0.0);
  for (double wander : {0.0, 0.3e-3, 1e-3})
    add(Core::kNormal, 2.4e-3, wander, 0.0, 0.0);
  for (double wander : {0.0, 1e-3})
    add(Core::kNormal, 2.4e-3, wander, 1.25e-3, 0.0);
  add(Core::kExponential, 5e-3, 0.0, 1.25e-3, 0.3);
  add(Core::kNormal, 2.4e-3, 0.3e-3, 1.25e-3, 0.3);
}

constexpr char kExplanation[] =
    "RMS error [ms] of the newest frame's exposure time after a session, 5 % of the frames lost, "
    "without the constant delay. Exponential delay of this mean, or normal delay of "
    "this standard deviation [ms]; wander of the camera's clock [ms in 10 s]; slots of 1.25 ms; "
    "stalls "
    "of up to 160 ms, one in 3 s. arrival: the arrival as stamp; line, hull, oracle: told the "
    "frame numbers; hull*: with the clock's. hull* and clock: to the nearest true exposure; total: "
    "with wrong frame numbers; err/sd: over clock_stddev; in_2sd: of total; us: per report.";

BenchmarkRow tableRow(const std::string& name, const TimingScore& s) {
  return {name,
          {{"arrival", s.arrival * 1e3},
           {"line", s.least_squares * 1e3},
           {"hull", s.convex_hull * 1e3},
           {"oracle", s.oracle * 1e3},
           {"hull*", s.convex_hull_own * 1e3},
           {"**clock**", s.clock * 1e3},
           {"total", s.total * 1e3},
           {"wrong%", s.wrong_frames * 100.0},
           {"err/sd", s.clock_ratio},
           {"in_2sd%", s.covered * 100.0},
           {"us", s.update_seconds * 1e6}}};
}

}  // namespace

int main(int argc, char** argv) {
  BenchmarkTables tables;
  int sessions = 200;
  std::uint64_t seed = 1;
  double duration = 10.0;  // [s]
  ArgumentParser parser("benchmark_timing",
                        "Errors of exposure times that are estimated from arrival times.");
  tables.addOptions(&parser);
  parser.option("--sessions N", &sessions, 2, 1000000000, "per row");
  parser.option("--seconds S", &duration, 1.0, 1e6, "duration of a session [s]");
  parser.option("--seed N", &seed, 0, std::numeric_limits<std::int64_t>::max(),
                "of the random numbers");
  return parser.run(argc, argv, [&] {
    tables.begin("timing", kExplanation,
                 format("rosrun wiimote_tracker_driver benchmark_timing --sessions %d --seconds %g "
                        "--seed %llu",
                        sessions, duration, static_cast<unsigned long long>(seed)));
    forLinks([&](const std::string& name, const LinkModel& link) {
      tables.add(tableRow(name, runTiming(link, duration, sessions, seed)));
    });
    tables.write();
    return 0;
  });
}
