// How good a calibration is, beside what is possible at best: one table per section.
#include "benchmark_calibration_sections.h"

#include <wiimote_tracker_msgs/argument_parser.h>

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

using namespace wiimote_tracker;

namespace {

/// JSON has no NaN.
void writeNumber(std::FILE* file, double value) {
  if (std::isfinite(value))
    std::fprintf(file, "%.9g", value);
  else
    std::fprintf(file, "null");
}

void runSection(const BenchmarkSection& section, int runs, bool first_section, std::FILE* json) {
  std::printf("\n%s: %s\n", section.name.c_str(), section.explanation.c_str());
  if (json)
    std::fprintf(json, "%s\n \"%s\": [", first_section ? "" : ",", section.name.c_str());
  bool first = true;
  section.run(runs, [&](const BenchmarkRow& row) {
    if (first) {
      std::printf("%-44s", "");
      for (const auto& [column, value] : row.figures)
        std::printf(" %10s", column.c_str());
      std::printf("\n");
    }
    std::printf("%-44s", row.name.c_str());
    for (const auto& [column, value] : row.figures)
      std::printf(" %10.4g", value);
    std::printf("  %s\n", row.note.c_str());
    std::fflush(stdout);
    if (json) {
      std::fprintf(json, "%s\n  {\"name\": \"%s\"", first ? "" : ",", row.name.c_str());
      for (const auto& [column, value] : row.figures) {
        std::fprintf(json, ", \"%s\": ", column.c_str());
        writeNumber(json, value);
      }
      std::fprintf(json, "}");
    }
    first = false;
  });
  if (json)
    std::fprintf(json, "\n ]");
}

/// All sections, or the one named `only`. @param path of the JSON; empty: none.
/// @returns the exit status.
int run(const std::vector<BenchmarkSection>& sections,
        const std::string& only,
        int runs,
        const std::string& path) {
  std::FILE* file = path.empty() ? nullptr : std::fopen(path.c_str(), "w");
  if (!path.empty() && !file) {
    std::perror(path.c_str());
    return 1;
  }
  std::printf("Simulated, %d sessions per row, fixed seeds.\n", runs);
  if (file)
    std::fprintf(file, "{");
  bool first = true;
  for (const BenchmarkSection& section : sections) {
    if (!only.empty() && section.name != only)
      continue;
    runSection(section, runs, first, file);
    first = false;
  }
  if (file)
    std::fprintf(file, "\n}\n");
  if (file && std::fclose(file) != 0) {
    std::perror(path.c_str());
    return 1;
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<BenchmarkSection> sections = {
      poseSection(),       poseMethodsSection(), waveSection(),   waveTimeSection(),
      measureSection(),    mistakesSection(),    paperSection(),  remapSection(),
      continuousSection(), knockSection(),       misledSection(), restSection(),
      monthSection()};
  std::vector<std::string> names;
  names.reserve(sections.size());
  for (const BenchmarkSection& section : sections)
    names.push_back(section.name);
  std::string path;
  std::string only;
  int runs = 20;
  ArgumentParser parser("benchmark_calibration", "Simulates, and prints one table per section.");
  parser.option("--json FILE", &path, "write the tables to this file, too");
  parser.option("--section NAME", &only, names, "run only this one");
  parser.option("--runs N", &runs, 2, 1000000000, "simulated sessions per row");
  return parser.run(argc, argv, [&] { return run(sections, only, runs, path); });
}
