#ifndef WIIMOTE_TRACKER_BRINGUP_EVALUATION_MONTE_CARLO_TABLE_H
#define WIIMOTE_TRACKER_BRINGUP_EVALUATION_MONTE_CARLO_TABLE_H

#include <cstddef>
#include <fstream>
#include <string>
#include <vector>

namespace wiimote_tracker::monte_carlo {

/// A CSV file with names in its first line. Numbers are written with nine digits; NaN as nan.
class Table {
 public:
  /// @throws std::runtime_error: the file cannot be written.
  Table(const std::string& path, const std::vector<std::string>& columns);

  /// The next cell of the present row; a row ends by itself with its last one.
  Table& operator<<(double value);
  Table& operator<<(int value);
  Table& operator<<(const std::string& text);  ///< Without commas and quotes.

  /// Ends the file. @throws std::runtime_error: a row is not complete, or the disk is full.
  void close();

 private:
  void next();

  std::string path_;
  std::ofstream file_;
  std::size_t columns_;
  std::size_t column_ = 0;
};

}  // namespace wiimote_tracker::monte_carlo

#endif  // WIIMOTE_TRACKER_BRINGUP_EVALUATION_MONTE_CARLO_TABLE_H
