#include "dataset.h"

#include "wiimote_tracker_triangulation/gesture/error.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace wiimote_tracker::gesture_tool {
namespace {

namespace fs = std::filesystem;

/// The numbers of a line; empty when there is anything else in it.
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

Sample readSample(const fs::path& file) {
  Sample sample{file.stem().string(), {}};
  const std::vector<std::vector<double>> rows = readRows(file.string(), 4);
  for (const std::vector<double>& row : rows)
    // From the first row on: milliseconds since 1970 leave a double few digits.
    sample.path.push_back({1e-3 * (row[3] - rows[0][3]), {row[0], row[1], row[2]}});
  return sample;
}

std::vector<fs::path> sortedEntries(const fs::path& folder) {
  std::vector<fs::path> entries;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    entries.push_back(entry.path());
  std::sort(entries.begin(), entries.end());
  return entries;
}

}  // namespace

std::vector<std::vector<double>> readRows(const std::string& file, std::size_t columns) {
  std::ifstream stream(file);
  if (!stream)
    throw gesture::GestureError(file + " cannot be read; check its name and rights");
  std::vector<std::vector<double>> rows;
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    std::vector<double> numbers = numbersOf(line);
    if (numbers.size() >= columns)
      rows.push_back(std::move(numbers));
    else if (!rows.empty() && line.find_first_not_of(" \t\r") != std::string::npos)
      throw gesture::GestureError(file + ", line " + std::to_string(number) + " is not " +
                                  std::to_string(columns) + " numbers; mend or remove it");
  }
  if (rows.empty())
    throw gesture::GestureError(file + " has no row of " + std::to_string(columns) +
                                " numbers; see --help for the layout");
  return rows;
}

std::vector<Person> readPeople(const std::string& folder) {
  std::error_code error;
  if (!fs::is_directory(folder, error))
    throw gesture::GestureError(folder + " is not a folder; give one with a folder per person");
  std::vector<Person> people;
  for (const fs::path& path : sortedEntries(folder)) {
    if (!fs::is_directory(path))
      continue;
    Person person{fs::canonical(path).string(), {}};
    for (const fs::path& file : sortedEntries(path)) {
      if (file.extension() == ".csv")
        person.samples.push_back(readSample(file));
    }
    if (!person.samples.empty())
      people.push_back(std::move(person));
  }
  if (people.empty())
    throw gesture::GestureError(folder +
                                " holds no gesture; it needs a folder per person, and in "
                                "it a CSV per gesture");
  return people;
}

}  // namespace wiimote_tracker::gesture_tool
