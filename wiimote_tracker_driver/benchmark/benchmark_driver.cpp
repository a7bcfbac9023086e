// Cost and reliability of the driver: processor time, 32 remotes at once, a month of reports,
// timing.
#include "cost_trial.h"
#include "load_trial.h"
#include "soak_trial.h"

#include <sys/wait.h>
#include <unistd.h>
#include <wiimote_tracker_msgs/argument_parser.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

using namespace wiimote_tracker;

namespace {

struct Options {
  std::string sections = "load,soak,timing";
  std::string json;
  int remotes = 32;
  double seconds = 30.0;  // [s]
  std::uint64_t reports = 60000000;
  double hour = 3600.0;  // [s]
};

bool asked(const Options& options, const std::string& section) {
  return ("," + options.sections + ",").find("," + section + ",") != std::string::npos;
}

/// The program beside this one. @returns its JSON.
std::string runTimingProgram() {
  char self[4096];
  const ssize_t size = ::readlink("/proc/self/exe", self, sizeof(self) - 1);
  const std::string here(self, size > 0 ? static_cast<std::size_t>(size) : 0);
  const std::string program = here.substr(0, here.rfind('/') + 1) + "benchmark_timing";
  char file[] = "/tmp/benchmark_timing_XXXXXX";
  const int fd = ::mkstemp(file);
  if (fd < 0)
    throw std::runtime_error("no file can be made in /tmp: make room there");
  ::close(fd);
  const pid_t child = ::fork();
  if (child == 0) {
    ::execl(program.c_str(), program.c_str(), "--json", file, nullptr);
    ::_exit(127);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  std::ifstream in(file);
  std::string text((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  ::unlink(file);
  if (status != 0)
    throw std::runtime_error(program + " did not run: build the whole package");
  while (!text.empty() && text.back() == '\n')
    text.pop_back();
  return text;
}

double value(const Results& results, const std::string& name) {
  for (const Result& result : results) {
    if (result.name == name)
      return result.value;
  }
  return 0.0;
}

int run(const Options& options) {
  std::string text;
  const auto add = [&text](const char* section, const std::string& content) {
    text += (text.empty() ? "{\n\"" : ",\n\"") + std::string(section) + "\": " + content;
  };
  bool good = true;
  if (asked(options, "load") && asked(options, "cost"))
    throw BadArguments("--sections: load and cost each need a run of their own");
  // These first, since they fork while this process has one thread.
  if (asked(options, "load")) {
    const Results results = runLoad(options.remotes, options.seconds);
    print("Load (virtual remotes in another process, nodelets and subscriber in this one)",
          results);
    add("load", json(results));
    good = good && value(results, "dropped") == 0.0;
  }
  if (asked(options, "cost")) {
    const Results results = runCost(options.seconds);
    print("Cost (driver_node and a node that only publishes the same message)", results);
    add("cost", json(results));
  }
  if (asked(options, "soak")) {
    const Results results = runSoak(options.reports, options.hour);
    print("Soak (simulated, one thread, full speed)", results);
    add("soak", json(results));
    for (const char* fault :
         {"allocations_not_freed_since_then", "clock_steps_not_noticed", "times_not_increasing"})
      good = good && value(results, fault) <= 0.0;
  }
  if (asked(options, "timing"))
    add("timing", "{\"unit\": \"s; wrong_*, error_over_stddev, within_2_stddev: 1\",\n\"rows\": " +
                      runTimingProgram() + "}");
  if (text.empty())
    throw BadArguments("--sections must name load, cost, soak or timing");
  if (!options.json.empty()) {
    std::ofstream file(options.json);
    file << text << "\n}\n";
    if (!file.flush())
      throw std::runtime_error("cannot write " + options.json + ": choose another file");
  }
  if (!good)
    std::printf("Reports were dropped, memory grew, or times are wrong: see above.\n");
  return good ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  ArgumentParser parser(
      "benchmark_driver",
      "load    virtual remotes at 100 Hz into driver nodelets in this process; brings its own ROS\n"
      "        master\n"
      "cost    processor time of driver_node, beside that of a node that only publishes\n"
      "soak    reports through decoder, state machine and stamper in fake time\n"
      "timing  the table of benchmark_timing");
  parser.option("--sections A,B,...", &options.sections, "what to run");
  parser.option("--json FILE", &options.json, "write the results to this file, too");
  parser.option("--remotes N", &options.remotes, 1, 256, "of the load");
  parser.option("--seconds S", &options.seconds, 1.0, 500.0, "of load and cost [s]");
  // At least more than a day's worth, so that what grows has time to.
  parser.option("--reports N", &options.reports, 10000000, 1000000000000, "of the soak");
  parser.option("--hour S", &options.hour, 5.0, 3600.0, "that the soak's hours last [s]");
  return parser.run(argc, argv, [&] { return run(options); });
}
