#include "gesture/examples_file.h"

#include "wiimote_tracker_triangulation/geometry/atomic_file.h"
#include "wiimote_tracker_triangulation/geometry/yaml_map.h"

#include <wiimote_tracker_msgs/text.h>

#include <yaml-cpp/yaml.h>

#include <array>

namespace wiimote_tracker::gesture {
namespace {

constexpr const char* kFormat = "wiimote_tracker_gestures";
constexpr int kFormatVersion = 1;
constexpr const char* kAdvice = "restore the file from its backup or record the gestures again";

Example readExample(geometry::YamlMap map) {
  Example example;
  example.gesture = map.get<std::string>("gesture");
  example.zone = map.get<std::string>("zone");
  for (const std::vector<double>& row : map.rows("path", 4, "t, x, y, z"))
    example.path.push_back({row[0], {row[1], row[2], row[3]}});
  return example;
}

}  // namespace

std::vector<Example> readExamples(const std::string& file) {
  geometry::YamlMap map = geometry::YamlMap::load(file, kAdvice);
  map.checkFormat(kFormat, kFormatVersion);
  std::vector<Example> examples;
  for (const geometry::YamlMap& example : map.maps("examples"))
    examples.push_back(readExample(example));
  map.refuseUnknown();
  return examples;
}

void writeExamples(const std::string& file, const std::vector<Example>& examples) {
  YAML::Emitter out;
  out << YAML::BeginMap;
  out << "format" << kFormat;
  out << "version" << kFormatVersion;
  out << "examples" << YAML::BeginSeq;
  for (const Example& example : examples) {
    out << YAML::BeginMap;
    out << "gesture" << YAML::DoubleQuoted << example.gesture;
    out << "zone" << YAML::DoubleQuoted << example.zone;
    out << "path" << YAML::Comment("t [s], x, y, z [m]") << YAML::BeginSeq;
    for (const PathPoint& point : example.path) {
      const Eigen::Vector3d& position = point.position;
      out << YAML::Flow
          << exactNumbers(std::array{point.time, position.x(), position.y(), position.z()});
    }
    out << YAML::EndSeq << YAML::EndMap;
  }
  out << YAML::EndSeq << YAML::EndMap;
  geometry::writeFileAtomically(file, std::string(out.c_str()) + "\n");
}

}  // namespace wiimote_tracker::gesture
