#pragma once

#include "wiimote_tracker_msgs/argument_parser.h"

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace wiimote_tracker {

/// One line of a table: what was measured, and each column's name and figure.
struct BenchmarkRow {
  std::string name;
  std::vector<std::pair<std::string, double>> figures;
  std::string note = {};  ///< In words, behind the figures.
};

/// Takes a row as soon as it is known. A row with other columns starts a new table.
using RowCallback = std::function<void(const BenchmarkRow&)>;

/// The tables of a benchmark program, one or more per section: printed row by row, and in the end
/// written as JSON and into a document, as far as these are asked for.
class BenchmarkTables {
 public:
  /// Adds --json and --document to the program's arguments.
  void addOptions(ArgumentParser* parser);

  /// Rows that follow belong to this section. @param explanation of its columns, for people.
  /// @param command with which the section can be measured again.
  /// @throws FileError: a file of the options cannot be written.
  void begin(const std::string& name, const std::string& explanation, const std::string& command);

  void add(const BenchmarkRow& row);

  /// Writes the files. @throws FileError.
  void write() const;

 private:
  struct Section {
    std::string name, explanation, command;
    std::vector<BenchmarkRow> rows;
  };

  std::string json() const;
  static std::string markdown(const Section& section);
  std::string withTables(std::string text) const;

  std::string json_, document_;  // paths; empty: none
  std::vector<Section> sections_;
};

}  // namespace wiimote_tracker
