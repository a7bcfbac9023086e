// How good a calibration is, beside what is possible at best: one table per section.
#include "benchmark_calibration_sections.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
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
    std::printf("\n");
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

int usage() {
  std::fprintf(stderr,
               "usage: benchmark_calibration [--json FILE] [--runs N, at least 2] "
               "[--section NAME]\n");
  return 2;
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<BenchmarkSection> sections = {poseSection(),  poseMethodsSection(),
                                                  waveSection(),  waveTimeSection(),
                                                  paperSection(), remapSection()};
  const char* json = nullptr;
  const char* only = nullptr;
  int runs = 20;
  for (int i = 1; i < argc; i += 2) {
    if (i + 1 >= argc)
      return usage();
    if (!std::strcmp(argv[i], "--json"))
      json = argv[i + 1];
    else if (!std::strcmp(argv[i], "--runs"))
      runs = std::atoi(argv[i + 1]);
    else if (!std::strcmp(argv[i], "--section"))
      only = argv[i + 1];
    else
      return usage();
  }
  if (runs < 2)
    return usage();
  std::FILE* file = json ? std::fopen(json, "w") : nullptr;
  if (json && !file) {
    std::perror(json);
    return 1;
  }
  std::printf("Simulated, %d sessions per row, fixed seeds.\n", runs);
  bool found = false;
  try {
    if (file)
      std::fprintf(file, "{");
    for (const BenchmarkSection& section : sections) {
      if (only && section.name != only)
        continue;
      runSection(section, runs, !found, file);
      found = true;
    }
    if (file)
      std::fprintf(file, "\n}\n");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  if (file && std::fclose(file) != 0) {
    std::perror(json);
    return 1;
  }
  if (!found) {
    std::fprintf(stderr, "no section %s; there are:\n", only);
    for (const BenchmarkSection& section : sections)
      std::fprintf(stderr, "  %s\n", section.name.c_str());
    return 2;
  }
  return 0;
}
