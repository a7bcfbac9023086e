// How good a calibration is, beside what is possible at best: one table per section.
#include "benchmark_calibration_sections.h"

#include <cstdio>
#include <string>
#include <vector>

using namespace wiimote_tracker;

int main(int argc, char** argv) {
  const std::vector<BenchmarkSection> sections = {
      waveSection(),      floorSection(),  measureSection(),    paperSection(),
      remapSection(),     roomsSection(),  continuousSection(), knockSection(),
      twoKnocksSection(), misledSection(), restSection(),       monthSection()};
  std::vector<std::string> names;
  names.reserve(sections.size());
  for (const BenchmarkSection& section : sections)
    names.push_back(section.name);
  BenchmarkTables tables;
  std::string only;
  int runs = 20;
  ArgumentParser parser("benchmark_calibration", "Simulates, and prints one table per section.");
  tables.addOptions(&parser);
  parser.option("--section NAME", &only, names, "run only this one");
  parser.option("--runs N", &runs, 2, 1000000000, "simulated sessions per row");
  return parser.run(argc, argv, [&] {
    std::printf("Simulated, %d sessions per row, fixed seeds.\n", runs);
    for (const BenchmarkSection& section : sections) {
      if (!only.empty() && section.name != only)
        continue;
      tables.begin(section.name, section.explanation,
                   format("rosrun wiimote_tracker_calibration benchmark_calibration --section %s "
                          "--runs %d",
                          section.name.c_str(), runs));
      section.run(runs, [&](const BenchmarkRow& row) { tables.add(row); });
    }
    tables.write();
    return 0;
  });
}
