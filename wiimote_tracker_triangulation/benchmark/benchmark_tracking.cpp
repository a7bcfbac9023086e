// How well LEDs are tracked, beside what is possible at best: one table per section.
#include "benchmark_tracking_sections.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <string>
#include <vector>

using namespace wiimote_tracker;

namespace {

/// The figures of a section, for people and, if wanted, as JSON.
class Table {
 public:
  explicit Table(std::FILE* json) : json_(json) {}

  void add(const BenchmarkRow& row) {
    std::vector<std::string> columns;
    for (const auto& [column, value] : row.figures)
      columns.push_back(column);
    if (columns != columns_) {
      std::printf("%-44s", "");
      for (const std::string& column : columns)
        std::printf(" %11s", column.c_str());
      std::printf("\n");
    }
    columns_ = columns;
    std::printf("%-44s", row.name.c_str());
    for (const auto& [column, value] : row.figures)
      std::printf(" %11.5g", value);
    std::printf("\n");
    std::fflush(stdout);
    if (json_)
      writeRow(row);
    first_ = false;
  }

 private:
  void writeRow(const BenchmarkRow& row) const {
    std::fprintf(json_, "%s\n  {\"name\": \"%s\"", first_ ? "" : ",", row.name.c_str());
    for (const auto& [column, value] : row.figures) {
      // JSON has no NaN.
      std::fprintf(json_, std::isfinite(value) ? ", \"%s\": %.9g" : ", \"%s\": null",
                   column.c_str(), value);
    }
    std::fprintf(json_, "}");
  }

  std::FILE* json_;
  std::vector<std::string> columns_;
  bool first_ = true;
};

void runSection(const BenchmarkSection& section,
                const BenchmarkSettings& settings,
                bool first_section,
                std::FILE* json) {
  std::printf("\n%s: %s\n", section.name.c_str(), section.explanation.c_str());
  if (json)
    std::fprintf(json, "%s\n \"%s\": [", first_section ? "" : ",", section.name.c_str());
  Table table(json);
  section.run(settings, [&](const BenchmarkRow& row) { table.add(row); });
  if (json)
    std::fprintf(json, "\n ]");
}

int usage() {
  std::fprintf(stderr,
               "usage: benchmark_tracking [--json FILE] [--section NAME] [--runs N, at least 1] "
               "[--seed N] [--motion FILE.csv]\n");
  return 2;
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<BenchmarkSection> sections = {
      filterSection(),   unsynchronisedSection(), associationSection(),
      identitySection(), throughputSection(),     scaleSection()};
  const char* json = nullptr;
  const char* only = nullptr;
  BenchmarkSettings settings;
  for (int i = 1; i < argc; i += 2) {
    if (i + 1 >= argc)
      return usage();
    if (!std::strcmp(argv[i], "--json"))
      json = argv[i + 1];
    else if (!std::strcmp(argv[i], "--section"))
      only = argv[i + 1];
    else if (!std::strcmp(argv[i], "--runs"))
      settings.runs = std::atoi(argv[i + 1]);
    else if (!std::strcmp(argv[i], "--seed"))
      settings.seed = static_cast<unsigned>(std::strtoul(argv[i + 1], nullptr, 10));
    else if (!std::strcmp(argv[i], "--motion"))
      settings.motion = argv[i + 1];
    else
      return usage();
  }
  if (settings.runs < 1)
    return usage();
  std::FILE* file = json ? std::fopen(json, "w") : nullptr;
  if (json && !file) {
    std::perror(json);
    return 1;
  }
  std::printf("Simulated; runs %d, seed %u.\n", settings.runs, settings.seed);
  bool found = false;
  try {
    if (file)
      std::fprintf(file, "{");
    for (const BenchmarkSection& section : sections) {
      if (only && section.name != only)
        continue;
      runSection(section, settings, !found, file);
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
