#include "label_places.h"

#include <filesystem>
#include <fstream>
#include <system_error>

namespace wiimote_tracker {

namespace fs = std::filesystem;

bool writePlaces(const std::string& file, const LedLabels::Places& places) {
  const std::string fresh = file + ".new";
  std::error_code error;
  fs::create_directories(fs::absolute(file).parent_path(), error);
  std::ofstream out(fresh);
  for (const auto& [label, place] : places)
    out << label << ' ' << place.position.transpose() << ' ' << place.speed << ' ' << place.age
        << ' ' << place.confidence << '\n';
  out.close();
  if (!out)
    return false;
  fs::rename(fresh, file, error);
  return !error;
}

LedLabels::Places readPlaces(const std::string& file, std::chrono::seconds oldest) {
  std::error_code error;
  const fs::file_time_type written = fs::last_write_time(file, error);
  const std::chrono::duration<double> age = fs::file_time_type::clock::now() - written;
  if (error || age > oldest)
    return {};
  std::ifstream in(file);
  LedLabels::Places places;
  std::string label;
  LedLabels::Place place;
  Eigen::Vector3d& position = place.position;
  while (in >> label >> position.x() >> position.y() >> position.z() >> place.speed >> place.age >>
         place.confidence) {
    place.age += age.count();
    places[label] = place;
  }
  return in.eof() ? places : LedLabels::Places();
}

}  // namespace wiimote_tracker
