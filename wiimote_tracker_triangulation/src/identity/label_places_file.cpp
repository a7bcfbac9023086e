#include "identity/label_places_file.h"

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <system_error>

namespace wiimote_tracker::identity {

namespace fs = std::filesystem;

namespace {

constexpr char kRig[] = "rig:";  // begins a file of places; no label has a colon

}  // namespace

std::string placesFile(const std::string& parameter, const std::string& name_space) {
  if (parameter.empty() || parameter.back() != '/')
    return parameter;
  return fs::path(parameter + name_space + "/label_places").lexically_normal().string();
}

std::error_code writePlaces(const std::string& file,
                            const std::string& rig_id,
                            const LedLabels::Places& places) {
  const std::string fresh = file + ".new";
  std::error_code error;
  const fs::path folder = fs::absolute(file).parent_path();
  if (!fs::is_directory(folder, error))  // see geometry/output_file.cpp
    fs::create_directories(folder, error);
  if (error)
    return error;
  errno = 0;
  std::ofstream out(fresh);
  out << kRig << ' ' << std::quoted(rig_id) << '\n';
  for (const auto& [label, place] : places)
    out << label << ' ' << place.position.transpose() << ' ' << place.speed << ' '
        << std::max(0.0, place.age) << ' ' << place.confidence << '\n';
  out.close();
  if (!out)
    return {errno != 0 ? errno : EIO, std::generic_category()};
  fs::rename(fresh, file, error);
  return error;
}

LedLabels::Places readPlaces(const std::string& file,
                             const std::string& rig_id,
                             std::chrono::seconds oldest) {
  std::error_code error;
  const fs::file_time_type written = fs::last_write_time(file, error);
  if (error)
    return {};
  // Not in the future, where a clock that was set back leaves it.
  const double age = std::max(
      0.0, std::chrono::duration<double>(fs::file_time_type::clock::now() - written).count());
  if (age > oldest.count())
    return {};
  std::ifstream in(file);
  LedLabels::Places places;
  std::string label, written_rig;
  if (in >> label && label != kRig)
    in.seekg(0);
  else if (in >> std::quoted(written_rig) && written_rig != rig_id)
    return {};
  LedLabels::Place place;
  Eigen::Vector3d& position = place.position;
  while (in >> label >> position.x() >> position.y() >> position.z() >> place.speed >> place.age >>
         place.confidence) {
    place.age += age;
    places[label] = place;
  }
  return in.eof() ? places : LedLabels::Places();
}

}  // namespace wiimote_tracker::identity
