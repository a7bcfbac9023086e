#pragma once

#include "description.h"

#include <cstddef>
#include <cstdint>
#include <fstream>
#include <functional>
#include <iomanip>
#include <stdexcept>
#include <string>
#include <vector>

namespace wiimote_tracker::monte_carlo {

/// A CSV file with column names in its first line. Numbers have nine digits; NaN is nan.
class Table {
 public:
  /// @throws std::runtime_error: the file cannot be written.
  Table(const std::string& path, const std::vector<std::string>& columns)
      : path_(path), file_(path), columns_(columns.size()) {
    if (!file_)
      throw std::runtime_error("cannot write to " + path + "; choose another --output");
    file_ << std::setprecision(9);
    for (const std::string& name : columns)
      *this << name;
  }

  /// Writes the next cell, a number or a text without commas and quotes; a row ends after its last
  /// one.
  template <typename Value>
  Table& operator<<(const Value& value) {
    file_ << value;
    ++column_;
    file_ << (column_ == columns_ ? '\n' : ',');
    column_ %= columns_;
    return *this;
  }

  /// Closes the file. @throws std::runtime_error: a row is incomplete, or the disk is full.
  void close() {
    if (column_ != 0)
      throw std::runtime_error("a row of " + path_ + " is not complete");
    file_.close();
    if (!file_)
      throw std::runtime_error("cannot write all of " + path_ + "; is the disk full?");
  }

 private:
  std::string path_;
  std::ofstream file_;
  std::size_t columns_;
  std::size_t column_ = 0;
};

/// One of the independent repetitions of a measurement.
struct Session {
  int number;
  std::uint32_t seed;  ///< Independent for different numbers and --seed.
};

/// A program's main(), with the arguments --rig FILE --output PATH [--seed N] [--sessions N]
/// [--first N]. `measure` gets the rig, the sessions and the path to write to.
/// @param purpose one sentence for --help. @returns the exit status.
int runProgram(int argc,
               char** argv,
               const std::string& purpose,
               const std::function<void(const simulation::Description&,
                                        const std::vector<Session>&,
                                        const std::string&)>& measure);

/// The same for a program that writes one table: `measure` adds a session's rows.
int runProgram(
    int argc,
    char** argv,
    const std::string& purpose,
    const std::vector<std::string>& columns,
    const std::function<void(const simulation::Description&, const Session&, Table*)>& measure);

}  // namespace wiimote_tracker::monte_carlo
