#ifndef WIIMOTE_TRACKER_BRINGUP_EVALUATION_MONTE_CARLO_TABLE_H
#define WIIMOTE_TRACKER_BRINGUP_EVALUATION_MONTE_CARLO_TABLE_H

#include <cstddef>
#include <fstream>
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

}  // namespace wiimote_tracker::monte_carlo

#endif  // WIIMOTE_TRACKER_BRINGUP_EVALUATION_MONTE_CARLO_TABLE_H
