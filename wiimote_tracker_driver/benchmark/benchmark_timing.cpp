// Exposure times from arrival times: our clock and others, for every model of the link.
#include "timing_trial.h"

#include <wiimote_tracker_msgs/argument_parser.h>
#include <wiimote_tracker_msgs/text.h>

#include <cstdint>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

using namespace wiimote_tracker::exposure_clock;

namespace {
struct Row {
  std::string name;
  LinkModel link;
};

std::vector<Row> rows() {
  using Core = LinkModel::Core;
  std::vector<Row> rows;
  const auto add = [&](Core core, double spread, double wander, double slot, double stalls) {
    LinkModel link;
    link.core = core;
    link.jitter = spread;
    link.wander = wander;
    link.slot = slot;
    link.stalls = stalls;
    const std::string name = wiimote_tracker::format(
        "%s %4.1f, wander %.1f%s%s", core == Core::kHardEdge ? "edge" : "bell", spread * 1e3,
        wander * 1e3, slot > 0.0 ? ", slots" : "", stalls > 0.0 ? ", stalls" : "");
    rows.push_back({name, link});
  };
  for (double spread : {2e-3, 5e-3, 10e-3})
    for (double wander : {0.0, 0.3e-3, 1e-3})
      add(Core::kHardEdge, spread, wander, 0.0, 0.0);
  for (double wander : {0.0, 1e-3})
    add(Core::kHardEdge, 5e-3, wander, 1.25e-3, 0.0);
  for (double wander : {0.0, 0.3e-3, 1e-3})
    add(Core::kBell, 2.4e-3, wander, 0.0, 0.0);
  for (double wander : {0.0, 1e-3})
    add(Core::kBell, 2.4e-3, wander, 1.25e-3, 0.0);
  add(Core::kHardEdge, 5e-3, 0.0, 1.25e-3, 0.3);
  add(Core::kBell, 2.4e-3, 0.3e-3, 1.25e-3, 0.3);
  return rows;
}

/// @param duration of a session [s]. @param json path of a file; empty: none.
/// @returns the exit status.
int run(int sessions, double duration, std::uint64_t seed, const std::string& json) {
  std::FILE* file = json.empty() ? nullptr : std::fopen(json.c_str(), "w");
  if (!json.empty() && !file) {
    std::perror(json.c_str());
    return 1;
  }
  std::printf(
      "Simulated. RMS error [ms] of the newest frame's exposure time after %.0f s, 5 %% of the "
      "frames\n"
      "lost, over %d sessions, less the constant delay. Line, hull, Olson and oracle are told the\n"
      "frame numbers; line* and hull* have the clock's; oracle* (edges only) finds its own. These\n"
      "and clock: to the nearest true exposure; total: with wrong frame numbers.\n\n"
      "%-36s %7s | %7s %7s %7s %7s | %7s %7s %7s %8s | %7s %7s %7s %8s %7s %6s\n",
      duration, sessions, "delay [ms]", "arrival", "line", "hull", "Olson", "oracle", "line*",
      "hull*", "oracle*", "wrong* %", "clock", "total", "wrong %", "err/sd", "in 2sd%", "us");
  if (file)
    std::fprintf(file, "[");
  bool first = true;
  for (const Row& row : rows()) {
    const TimingScore s = runTiming(row.link, duration, sessions, true, seed);
    std::printf(
        "%-36s %7.3f | %7.3f %7.3f %7.3f %7.3f | %7.3f %7.3f %7.3f %8.1f | %7.3f %7.3f %7.1f %8.2f "
        "%7.1f "
        "%6.1f\n",
        row.name.c_str(), s.arrival * 1e3, s.least_squares * 1e3, s.convex_hull * 1e3,
        s.olson * 1e3, s.oracle * 1e3, s.least_squares_own * 1e3, s.convex_hull_own * 1e3,
        s.blind_oracle * 1e3, s.blind_oracle_wrong_frames * 100.0, s.clock * 1e3, s.total * 1e3,
        s.wrong_frames * 100.0, s.clock_ratio, s.covered * 100.0, s.update_seconds * 1e6);
    std::fflush(stdout);
    if (file)
      std::fprintf(file,
                   "%s\n {\"delay\": \"%s\", \"sessions\": %d, \"arrival\": %.9f, "
                   "\"least_squares\": %.9f, \"convex_hull\": %.9f, \"olson\": %.9f, \"oracle\": "
                   "%.9f, \"least_squares_own\": %.9f, \"convex_hull_own\": %.9f, "
                   "\"blind_oracle\": %.9f, \"blind_oracle_wrong_frames\": %.6f, \"clock\": %.9f, "
                   "\"total\": %.9f, \"wrong_frames\": %.6f, "
                   "\"error_over_stddev\": %.4f, \"within_2_stddev\": %.6f, \"update\": %.9f}",
                   first ? "" : ",", row.name.c_str(), sessions, s.arrival, s.least_squares,
                   s.convex_hull, s.olson, s.oracle, s.least_squares_own, s.convex_hull_own,
                   s.blind_oracle, s.blind_oracle_wrong_frames, s.clock, s.total, s.wrong_frames,
                   s.clock_ratio, s.covered, s.update_seconds);
    first = false;
  }
  if (file) {
    std::fprintf(file, "\n]\n");
    if (std::fclose(file) != 0) {
      std::perror(json.c_str());
      return 1;
    }
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  std::string json;
  int sessions = 200;
  std::uint64_t seed = 1;
  double duration = 10.0;
  wiimote_tracker::ArgumentParser parser(
      "benchmark_timing", "Errors of exposure times that are estimated from arrival times.");
  parser.option("--json FILE", &json, "write the table to this file, too");
  parser.option("--sessions N", &sessions, 2, 1000000000, "per row");
  parser.option("--seconds S", &duration, 1.0, 1e6, "duration of a session [s]");
  parser.option("--seed N", &seed, 0, std::numeric_limits<std::int64_t>::max(),
                "of the random numbers");
  return parser.run(argc, argv, [&] { return run(sessions, duration, seed, json); });
}
