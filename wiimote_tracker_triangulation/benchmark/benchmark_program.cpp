#include "benchmark_program.h"

#include <cstdio>

namespace wiimote_tracker {

double processorTime() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

int runBenchmark(const std::string& program,
                 const std::vector<BenchmarkSection>& sections,
                 int argc,
                 char** argv,
                 const std::function<void(ArgumentParser*, BenchmarkSettings*)>& add_options) {
  BenchmarkSettings settings;
  BenchmarkTables tables;
  std::string only;
  std::vector<std::string> names;
  for (const BenchmarkSection& section : sections)
    names.push_back(section.name);
  ArgumentParser parser(program, "Simulates, and prints one table per section.");
  tables.addOptions(&parser);
  parser.option("--section NAME", &only, names, "run only this one");
  parser.option("--runs N", &settings.runs, 1, 1000000000, "repetitions per row");
  parser.option("--seed N", &settings.seed, 0, 4294967295, "of the random numbers");
  if (add_options)
    add_options(&parser, &settings);
  return parser.run(argc, argv, [&] {
    std::printf("Simulated; runs %d, seed %u.\n", settings.runs, settings.seed);
    for (const BenchmarkSection& section : sections) {
      if (!only.empty() && section.name != only)
        continue;
      tables.begin(
          section.name, section.explanation,
          format("rosrun wiimote_tracker_triangulation %s --section %s --runs %d --seed %u",
                 program.c_str(), section.name.c_str(), settings.runs, settings.seed));
      section.run(settings, [&](const BenchmarkRow& row) { tables.add(row); });
    }
    tables.write();
    return 0;
  });
}

}  // namespace wiimote_tracker
