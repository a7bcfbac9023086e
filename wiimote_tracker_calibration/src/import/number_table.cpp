#include "wiimote_tracker_calibration/import/recording.h"

#include <wiimote_tracker_msgs/text.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>

namespace wiimote_tracker::import {

namespace {

std::ifstream open(const std::string& path) {
  std::ifstream file(path);
  // A folder opens like a file, but has no first character.
  if (!file || (file.peek(), file.bad()))
    throw ImportError(path + " is missing or cannot be read");
  return file;
}

}  // namespace

double parseNumber(const std::string& text, const std::string& where) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0')
    throw ImportError(where + ": '" + text + "' is not a number");
  if (std::isinf(value))
    throw ImportError(where + ": '" + text + "' is not a finite number");
  return value;
}

NumberTable readNumberTable(const std::string& path, std::size_t rows, std::size_t columns) {
  std::ifstream file = open(path);
  NumberTable table;
  std::string line;
  for (std::size_t number = 1; std::getline(file, line); ++number) {
    const std::string in_line = path + " line " + std::to_string(number);
    std::istringstream words(line.substr(0, line.find('#')));  // Octave's headers
    std::vector<double> row;
    for (std::string word; words >> word;)
      row.push_back(parseNumber(word, in_line + " column " + std::to_string(row.size() + 1)));
    if (row.empty())
      continue;
    if (!table.empty() && row.size() != table.front().size())
      throw ImportError(in_line + " has " + counted(row.size(), "column") + ", but the first has " +
                        std::to_string(table.front().size()));
    table.push_back(row);
  }
  if (table.empty())
    throw ImportError(path + " is empty");
  if (rows != 0 && table.size() != rows)
    throw ImportError(path + " has " + counted(table.size(), "row") + ", but must have " +
                      std::to_string(rows));
  if (columns != 0 && table.front().size() != columns)
    throw ImportError(path + " has " + counted(table.front().size(), "column") +
                      ", but must have " + std::to_string(columns));
  return table;
}

std::vector<std::string> readLines(const std::string& path) {
  const std::string kBlanks = " \t\r";
  std::ifstream file = open(path);
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) {
    const std::size_t first = line.find_first_not_of(kBlanks);
    if (first != std::string::npos)
      lines.push_back(line.substr(first, line.find_last_not_of(kBlanks) - first + 1));
  }
  return lines;
}

bool fileExists(const std::string& path) {
  return std::ifstream(path).good();
}

}  // namespace wiimote_tracker::import
