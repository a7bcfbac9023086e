#include "body/bodies_file.h"

#include "wiimote_tracker_triangulation/geometry/atomic_file.h"
#include "wiimote_tracker_triangulation/geometry/yaml_map.h"

#include <wiimote_tracker_msgs/text.h>

#include <yaml-cpp/yaml.h>

#include <filesystem>

namespace wiimote_tracker::body {
namespace {

constexpr const char* kFormat = "wiimote_tracker_bodies";
constexpr int kFormatVersion = 1;
constexpr const char* kAdvice = "correct the file";

Constellation readBody(geometry::YamlMap map) {
  Constellation body;
  body.name = map.get<std::string>("name");
  for (const std::vector<double>& led : map.rows("leds", 3, "x, y, z"))
    body.leds.emplace_back(led[0], led[1], led[2]);
  body.labels = map.get("labels", body.labels);
  map.refuseUnknown();
  return body;
}

Constellation readMarkerPositions(geometry::YamlMap map, const std::string& file) {
  Constellation body;
  body.name = std::filesystem::path(file).stem().string();
  for (geometry::YamlMap& led : map.maps("marker_positions")) {
    body.leds.emplace_back(led.get<double>("x"), led.get<double>("y"), led.get<double>("z"));
    led.refuseUnknown();
  }
  map.refuseUnknown();
  return body;
}

}  // namespace

std::vector<Constellation> readBodies(const std::string& file) {
  std::vector<Constellation> bodies;
  geometry::YamlMap map = geometry::YamlMap::load(file, kAdvice);
  if (map.has("marker_positions")) {
    bodies = {readMarkerPositions(map, file)};
  } else {
    map.checkFormat(kFormat, kFormatVersion);
    for (const geometry::YamlMap& body : map.maps("bodies"))
      bodies.push_back(readBody(body));
    map.refuseUnknown();
  }
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    bodies[i].check();
    for (std::size_t k = 0; k < i; ++k) {
      if (bodies[k].name == bodies[i].name)
        throw FileError(file + " has two bodies named '" + bodies[i].name + "'; rename one");
    }
  }
  return bodies;
}

void writeBodies(const std::string& file, const std::vector<Constellation>& bodies) {
  YAML::Emitter out;
  out << YAML::BeginMap;
  out << YAML::Key << "format" << YAML::Value << kFormat;
  out << YAML::Key << "version" << YAML::Value << kFormatVersion;
  out << YAML::Key << "bodies" << YAML::Value << YAML::BeginSeq;
  for (const Constellation& body : bodies) {
    out << YAML::BeginMap;
    out << YAML::Key << "name" << YAML::Value << YAML::DoubleQuoted << body.name;
    out << YAML::Key << "leds" << YAML::Comment("x, y, z [m]") << YAML::Value << YAML::BeginSeq;
    for (const Eigen::Vector3d& led : body.leds)
      out << YAML::Flow << YAML::BeginSeq << exactNumber(led.x()) << exactNumber(led.y())
          << exactNumber(led.z()) << YAML::EndSeq;
    out << YAML::EndSeq;
    if (!body.labels.empty()) {
      out << YAML::Key << "labels" << YAML::Value << YAML::Flow << YAML::BeginSeq;
      for (const std::string& label : body.labels)
        out << YAML::DoubleQuoted << label;
      out << YAML::EndSeq;
    }
    out << YAML::EndMap;
  }
  out << YAML::EndSeq << YAML::EndMap;
  geometry::writeFileAtomically(file, std::string(out.c_str()) + "\n");
}

}  // namespace wiimote_tracker::body
