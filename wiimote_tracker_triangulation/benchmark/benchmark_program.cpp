#include "benchmark_program.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>

namespace wiimote_tracker {
namespace {

struct Arguments {
  std::string json;
  std::string section;
  BenchmarkSettings settings;
};

bool parse(int argc, char** argv, bool takes_motion, Arguments* arguments) {
  for (int i = 1; i < argc; i += 2) {
    if (i + 1 >= argc)
      return false;
    const std::string option = argv[i];
    if (option == "--json")
      arguments->json = argv[i + 1];
    else if (option == "--section")
      arguments->section = argv[i + 1];
    else if (option == "--runs")
      arguments->settings.runs = std::atoi(argv[i + 1]);
    else if (option == "--seed")
      arguments->settings.seed = static_cast<unsigned>(std::strtoul(argv[i + 1], nullptr, 10));
    else if (takes_motion && option == "--motion")
      arguments->settings.motion = argv[i + 1];
    else
      return false;
  }
  return arguments->settings.runs >= 1;
}

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

}  // namespace

int runBenchmark(const std::string& program,
                 const std::vector<BenchmarkSection>& sections,
                 int argc,
                 char** argv,
                 bool takes_motion) {
  Arguments arguments;
  if (!parse(argc, argv, takes_motion, &arguments)) {
    std::fprintf(stderr,
                 "usage: %s [--json FILE] [--section NAME] [--runs N, at least 1] [--seed N]%s\n",
                 program.c_str(), takes_motion ? " [--motion FILE.csv]" : "");
    return 2;
  }
  std::FILE* json = arguments.json.empty() ? nullptr : std::fopen(arguments.json.c_str(), "w");
  if (!arguments.json.empty() && !json) {
    std::perror(arguments.json.c_str());
    return 1;
  }
  std::printf("Simulated; runs %d, seed %u.\n", arguments.settings.runs, arguments.settings.seed);
  bool found = false;
  try {
    if (json)
      std::fprintf(json, "{");
    for (const BenchmarkSection& section : sections) {
      if (!arguments.section.empty() && section.name != arguments.section)
        continue;
      runSection(section, arguments.settings, !found, json);
      found = true;
    }
    if (json)
      std::fprintf(json, "\n}\n");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  if (json && std::fclose(json) != 0) {
    std::perror(arguments.json.c_str());
    return 1;
  }
  if (!found) {
    std::fprintf(stderr, "no section %s; there are:\n", arguments.section.c_str());
    for (const BenchmarkSection& section : sections)
      std::fprintf(stderr, "  %s\n", section.name.c_str());
    return 2;
  }
  return 0;
}

}  // namespace wiimote_tracker
