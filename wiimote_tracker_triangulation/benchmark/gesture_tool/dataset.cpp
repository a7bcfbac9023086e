#include "dataset.h"

#include "wiimote_tracker_triangulation/geometry/error.h"
#include "wiimote_tracker_triangulation/gesture/path_file.h"

#include <algorithm>
#include <filesystem>

namespace wiimote_tracker::gesture_tool {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> sortedEntries(const fs::path& folder) {
  std::vector<fs::path> entries;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    entries.push_back(entry.path());
  std::sort(entries.begin(), entries.end());
  return entries;
}

}  // namespace

std::vector<Person> readPeople(const std::string& folder) {
  std::error_code error;
  if (!fs::is_directory(folder, error))
    throw Error(folder + " is not a folder; give one with a folder per person");
  std::vector<Person> people;
  for (const fs::path& path : sortedEntries(folder)) {
    if (!fs::is_directory(path))
      continue;
    Person person{fs::canonical(path).string(), {}};
    for (const fs::path& file : sortedEntries(path)) {
      if (file.extension() == ".csv")
        person.samples.push_back({file.stem().string(), gesture::readPath(file.string())});
    }
    if (!person.samples.empty())
      people.push_back(std::move(person));
  }
  if (people.empty())
    throw Error(folder +
                " holds no gesture; it needs a folder per person, and in "
                "it a CSV per gesture");
  return people;
}

}  // namespace wiimote_tracker::gesture_tool
