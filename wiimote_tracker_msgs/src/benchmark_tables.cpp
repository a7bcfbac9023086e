#include "wiimote_tracker_msgs/benchmark_tables.h"

#include "wiimote_tracker_msgs/error.h"
#include "wiimote_tracker_msgs/text.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>

namespace wiimote_tracker {
namespace {

bool sameColumns(const BenchmarkRow& a, const BenchmarkRow& b) {
  return std::equal(a.figures.begin(), a.figures.end(), b.figures.begin(), b.figures.end(),
                    [](const auto& x, const auto& y) { return x.first == y.first; });
}

int width(const std::string& column) {
  return static_cast<int>(std::max<std::size_t>(column.size(), 10));
}

void printColumns(const BenchmarkRow& row) {
  std::printf("%-44s", "");
  for (const auto& [column, value] : row.figures)
    std::printf(" %*s", width(column), column.c_str());
  std::printf("\n");
}

void writeFile(const std::string& path, const std::string& text) {
  std::ofstream file(path);
  file << text;
  if (!file.flush())
    throw FileError(path + " cannot be written: choose another file");
}

}  // namespace

void BenchmarkTables::addOptions(ArgumentParser* parser) {
  parser->option("--json FILE", &json_, "write the tables to this file, too");
  parser->option("--document FILE", &document_,
                 "put each section's tables into this Markdown file, between the lines "
                 "<!-- SECTION: begin --> and <!-- SECTION: end -->; at its end where they are "
                 "missing");
}

void BenchmarkTables::begin(const std::string& name,
                            const std::string& explanation,
                            const std::string& command) {
  for (const std::string& path : {json_, document_}) {
    if (!path.empty() && !std::ofstream(path, std::ios::app))
      throw FileError(path + " cannot be written: choose another file");
  }
  sections_.push_back({name, explanation, command, {}});
  std::printf("\n%s: %s\n", name.c_str(), explanation.c_str());
}

void BenchmarkTables::add(const BenchmarkRow& row) {
  std::vector<BenchmarkRow>& rows = sections_.back().rows;
  if (rows.empty() || !sameColumns(rows.back(), row))
    printColumns(row);
  std::printf("%-44s", row.name.c_str());
  for (const auto& [column, value] : row.figures)
    std::printf(" %*.5g", width(column), value);
  std::printf("  %s\n", row.note.c_str());
  std::fflush(stdout);
  rows.push_back(row);
}

void BenchmarkTables::write() const {
  if (!json_.empty())
    writeFile(json_, json());
  if (document_.empty())
    return;
  std::ifstream file(document_);
  std::stringstream text;
  text << file.rdbuf();
  writeFile(document_, withTables(text.str()));
}

std::string BenchmarkTables::json() const {
  std::string text;
  for (const Section& section : sections_) {
    std::string rows;
    for (const BenchmarkRow& row : section.rows) {
      rows += (rows.empty() ? "" : ",") + format("\n  {\"name\": \"%s\"", row.name.c_str());
      for (const auto& [column, value] : row.figures) {
        // JSON has no NaN.
        rows += format(std::isfinite(value) ? ", \"%s\": %.9g" : ", \"%s\": null", column.c_str(),
                       value);
      }
      rows += "}";
    }
    text +=
        (text.empty() ? "" : ",") + format("\n \"%s\": [", section.name.c_str()) + rows + "\n ]";
  }
  return "{" + text + "\n}\n";
}

std::string BenchmarkTables::markdown(const Section& section) {
  const bool notes = std::any_of(section.rows.begin(), section.rows.end(),
                                 [](const BenchmarkRow& row) { return !row.note.empty(); });
  std::string text = "## " + section.name + "\n\n" + section.explanation + "\n";
  for (std::size_t i = 0; i < section.rows.size(); ++i) {
    const BenchmarkRow& row = section.rows[i];
    if (i == 0 || !sameColumns(section.rows[i - 1], row)) {
      text += "\n|";
      std::string rule = "\n|---|";
      for (const auto& [column, value] : row.figures) {
        text += "|" + column;
        rule += "---|";
      }
      text += (notes ? "||" : "|") + rule + (notes ? "---|\n" : "\n");
    }
    text += "|" + row.name + "|";
    for (const auto& [column, value] : row.figures)
      text += (std::isfinite(value) ? format(std::abs(value) < 1e4 ? "%.4g" : "%.0f", value) : "") +
              "|";
    text += notes ? row.note + "|\n" : "\n";
  }
  return text + "\nBy `" + section.command + "`.\n";
}

std::string BenchmarkTables::withTables(std::string text) const {
  for (const Section& section : sections_) {
    const std::string begin = "<!-- " + section.name + ": begin -->\n";
    const std::string end = "<!-- " + section.name + ": end -->\n";
    const std::size_t from = text.find(begin);
    const std::size_t to = text.find(end);
    if (from == std::string::npos && to == std::string::npos)
      text += "\n" + begin + markdown(section) + end;
    else if (from == std::string::npos || to == std::string::npos || to < from)
      throw FileError(document_ + ": write the line '" + begin.substr(0, begin.size() - 1) +
                      "' before '" + end.substr(0, end.size() - 1) + "'");
    else
      text.replace(from, to - from, begin + markdown(section));
  }
  return text;
}

}  // namespace wiimote_tracker
