#include "benchmark_program.h"

#include <wiimote_tracker_msgs/argument_parser.h>

#include <cmath>
#include <cstdio>

namespace wiimote_tracker {
namespace {

struct Arguments {
  std::string json;
  std::string section;
  BenchmarkSettings settings;
};

void printRow(const BenchmarkRow& row, std::vector<std::string>* columns) {
  std::vector<std::string> names;
  for (const auto& [column, value] : row.figures)
    names.push_back(column);
  if (names != *columns) {
    std::printf("%-44s", "");
    for (const std::string& name : names)
      std::printf(" %13s", name.c_str());
    std::printf("\n");
  }
  *columns = names;
  std::printf("%-44s", row.name.c_str());
  for (const auto& [column, value] : row.figures)
    std::printf(" %13.5g", value);
  std::printf("\n");
  std::fflush(stdout);
}

void writeRow(const BenchmarkRow& row, bool first, std::FILE* json) {
  std::fprintf(json, "%s\n  {\"name\": \"%s\"", first ? "" : ",", row.name.c_str());
  for (const auto& [column, value] : row.figures) {
    // JSON has no NaN.
    std::fprintf(json, std::isfinite(value) ? ", \"%s\": %.9g" : ", \"%s\": null", column.c_str(),
                 value);
  }
  std::fprintf(json, "}");
}

void runSection(const BenchmarkSection& section,
                const BenchmarkSettings& settings,
                bool first_section,
                std::FILE* json) {
  std::printf("\n%s: %s\n", section.name.c_str(), section.explanation.c_str());
  if (json)
    std::fprintf(json, "%s\n \"%s\": [", first_section ? "" : ",", section.name.c_str());
  std::vector<std::string> columns;
  bool first = true;
  section.run(settings, [&](const BenchmarkRow& row) {
    printRow(row, &columns);
    if (json)
      writeRow(row, first, json);
    first = false;
  });
  if (json)
    std::fprintf(json, "\n ]");
}

/// @returns the exit status.
int run(const std::vector<BenchmarkSection>& sections, const Arguments& arguments) {
  std::FILE* json = arguments.json.empty() ? nullptr : std::fopen(arguments.json.c_str(), "w");
  if (!arguments.json.empty() && !json) {
    std::perror(arguments.json.c_str());
    return 1;
  }
  std::printf("Simulated; runs %d, seed %u.\n", arguments.settings.runs, arguments.settings.seed);
  if (json)
    std::fprintf(json, "{");
  bool first = true;
  for (const BenchmarkSection& section : sections) {
    if (!arguments.section.empty() && section.name != arguments.section)
      continue;
    runSection(section, arguments.settings, first, json);
    first = false;
  }
  if (json)
    std::fprintf(json, "\n}\n");
  if (json && std::fclose(json) != 0) {
    std::perror(arguments.json.c_str());
    return 1;
  }
  return 0;
}

}  // namespace

int runBenchmark(const std::string& program,
                 const std::vector<BenchmarkSection>& sections,
                 int argc,
                 char** argv,
                 bool takes_motion) {
  Arguments arguments;
  std::vector<std::string> names;
  for (const BenchmarkSection& section : sections)
    names.push_back(section.name);
  ArgumentParser parser(program, "Simulates, and prints one table per section.");
  parser.option("--json FILE", &arguments.json, "write the tables to this file, too");
  parser.option("--section NAME", &arguments.section, names, "run only this one");
  parser.option("--runs N", &arguments.settings.runs, 1, 1000000000, "repetitions per row");
  parser.option("--seed N", &arguments.settings.seed, 0, 4294967295, "of the random numbers");
  if (takes_motion)
    parser.option("--motion FILE.csv", &arguments.settings.motion,
                  "recorded motion [mm] for the section filter");
  return parser.run(argc, argv, [&] { return run(sections, arguments); });
}

}  // namespace wiimote_tracker
