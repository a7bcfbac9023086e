#include "wiimote_tracker_triangulation/gesture/path_file.h"

#include "wiimote_tracker_triangulation/geometry/error.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <utility>

namespace wiimote_tracker::gesture {
namespace {

/// The numbers of a line; empty when it contains anything else.
std::vector<double> numbersOf(std::string line) {
  std::replace(line.begin(), line.end(), ',', ' ');
  std::vector<double> numbers;
  const char* at = line.c_str();
  while (true) {
    while (*at == ' ' || *at == '\t' || *at == '\r')
      ++at;
    if (*at == '\0')
      return numbers;
    char* end = nullptr;
    const double number = std::strtod(at, &end);
    if (end == at)
      return {};
    numbers.push_back(number);
    at = end;
  }
}

}  // namespace

Path readPath(const std::string& file) {
  const std::vector<std::vector<double>> rows = readRows(file, 4);
  Path path;
  path.reserve(rows.size());
  for (const std::vector<double>& row : rows)
    // Relative to the first row: milliseconds since 1970 would cost a double its fine digits.
    path.push_back({1e-3 * (row[3] - rows[0][3]), {row[0], row[1], row[2]}});
  return path;
}

std::vector<std::vector<double>> readRows(const std::string& file, std::size_t columns) {
  std::ifstream stream(file);
  if (!stream)
    throw Error(file + " cannot be read; check its name and rights");
  std::vector<std::vector<double>> rows;
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    std::vector<double> numbers = numbersOf(line);
    if (numbers.size() >= columns)
      rows.push_back(std::move(numbers));
    else if (!rows.empty() && line.find_first_not_of(" \t\r") != std::string::npos)
      throw Error(file + ", line " + std::to_string(number) + " is not " + std::to_string(columns) +
                  " numbers; correct or remove it");
  }
  if (rows.empty())
    throw Error(file + " has no row of " + std::to_string(columns) +
                " numbers; give a CSV with one position per row");
  return rows;
}

}  // namespace wiimote_tracker::gesture
