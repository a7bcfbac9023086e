// Cost and reliability of the driver: processor time, 32 remotes at once, a month of reports.
#include "trials.h"

#include <wiimote_tracker_msgs/benchmark_tables.h>

#include <cstdint>
#include <cstdio>
#include <functional>
#include <map>
#include <set>
#include <string>

using namespace wiimote_tracker;

namespace {

constexpr char kLoad[] =
    "virtual remotes at 100 Hz in one process; a driver nodelet for each and a subscriber to all "
    "ir_blobs in another, of which the processor time is given. Latency: from the remote's sample "
    "to the subscriber's callback; other programs on the machine lengthen it.";
constexpr char kCost[] =
    "processor time of driver_node with one virtual remote, and of a node that only publishes the "
    "same message, as in ROS's tutorials: both at 100 Hz on one processor, in turn without and "
    "with a subscriber. Without one the driver makes no message, the other node makes all of them.";
constexpr char kSoak[] =
    "reports through decoder, session (extended format) and stamper in simulated time. Each hour "
    "the remote reconnects, loses its mode or is power-cycled; batteries last 40 hours. The "
    "computer's clock is 100 ppm fast, is set right every noon, has a leap second, and passes 2^31 "
    "s. Wrong: off by more than 1 ms and five stated deviations (from 30 s after the begin of an "
    "epoch), probably first images after pauses, taken for delayed ones.";

struct Section {
  const char* explanation;
  std::string arguments;  // of the command line
  std::function<Results()> run;
};

int run(const std::string& name, const Section& section, BenchmarkTables* tables) {
  tables->begin(
      name, section.explanation,
      "rosrun wiimote_tracker_driver benchmark_driver --section " + name + section.arguments);
  // Load and cost fork while this process has one thread.
  const std::set<std::string> faults = {"dropped", "allocations_not_freed_since_then",
                                        "clock_steps_not_noticed", "times_not_increasing"};
  bool faulty = false;
  for (const Result& result : section.run()) {
    tables->add({result.name, {{"value", result.value}}, result.unit});
    faulty |= faults.count(result.name) > 0 && result.value > 0.0;
  }
  tables->write();
  if (faulty)
    std::printf("Reports were dropped, memory grew, or times are wrong: see above.\n");
  return faulty ? 1 : 0;
}

}  // namespace

int main(int argc, char** argv) {
  std::string name = "load";
  int remotes = 32;
  double seconds = 30.0;  // [s]
  std::uint64_t reports = 60000000;
  double hour = 3600.0;  // [s]
  BenchmarkTables tables;
  ArgumentParser parser(
      "benchmark_driver",
      "load    virtual remotes at 100 Hz into driver nodelets in this process\n"
      "cost    processor time of driver_node, beside that of a node that only publishes\n"
      "soak    reports through decoder, state machine and stamper in fake time\n"
      "Load and cost bring their own ROS master. The exit status is 1 when reports were dropped,\n"
      "memory grew, or times went back.");
  tables.addOptions(&parser);
  parser.option("--section NAME", &name, {"load", "cost", "soak"}, "what to run");
  parser.option("--remotes N", &remotes, 1, 256, "of the load");
  parser.option("--seconds S", &seconds, 1.0, 500.0, "of load and cost [s]");
  // At least more than a day's worth, so that what grows has time to.
  parser.option("--reports N", &reports, 10000000, 1000000000000, "of the soak");
  parser.option("--hour S", &hour, 5.0, 3600.0, "that the soak's hours last [s]");
  return parser.run(argc, argv, [&] {
    const std::map<std::string, Section> sections = {
        {"load",
         {kLoad, format(" --remotes %d --seconds %g", remotes, seconds),
          [&] { return runLoad(remotes, seconds); }}},
        {"cost", {kCost, format(" --seconds %g", seconds), [&] { return runCost(seconds); }}},
        {"soak",
         {kSoak,
          format(" --reports %llu --hour %g", static_cast<unsigned long long>(reports), hour),
          [&] { return runSoak(reports, hour); }}}};
    return run(name, sections.at(name), &tables);
  });
}
