#include "wiimote_tracker_triangulation/body/bodies_file.h"

#include "wiimote_tracker_triangulation/body/error.h"
#include "wiimote_tracker_triangulation/geometry/atomic_file.h"
#include "wiimote_tracker_triangulation/geometry/yaml_map.h"

#include <yaml-cpp/yaml.h>

#include <cstdio>
#include <filesystem>

namespace wiimote_tracker::body {
namespace {

constexpr const char* kFormat = "wiimote_tracker_bodies";
constexpr int kFormatVersion = 1;
constexpr const char* kAdvice = "correct the file";

std::string exact(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.17g", value);
  return text;
}

Constellation readBody(geometry::YamlMap map) {
  Constellation body;
  body.name = map.get<std::string>("name");
  for (const std::vector<double>& led : map.get<std::vector<std::vector<double>>>("leds")) {
    if (led.size() != 3)
      throw BodyError(map.at("leds") + " has an LED that is not [x, y, z]; " + kAdvice);
    body.leds.emplace_back(led[0], led[1], led[2]);
  }
  if (map.has("labels"))
    body.labels = map.get<std::vector<std::string>>("labels");
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

std::vector<Constellation> readNode(const YAML::Node& node, const std::string& file) {
  geometry::YamlMap map(node, file, kAdvice);
  if (map.has("marker_positions"))
    return {readMarkerPositions(map, file)};
  if (map.get<std::string>("format") != kFormat)
    throw BodyError(map.at("format") + " is not " + kFormat + "; give a file of bodies");
  const int version = map.get<int>("version");
  if (version != kFormatVersion)
    throw BodyError(map.at("version") + " is " + std::to_string(version) +
                    ", which this program does not know; update it");
  std::vector<Constellation> bodies;
  for (const geometry::YamlMap& body : map.maps("bodies"))
    bodies.push_back(readBody(body));
  map.refuseUnknown();
  return bodies;
}

}  // namespace

std::vector<Constellation> readBodies(const std::string& file) {
  std::vector<Constellation> bodies;
  try {
    bodies = readNode(YAML::Load(geometry::readFile(file)), file);
  } catch (const YAML::Exception& e) {
    throw BodyError(file + " is not YAML (" + e.what() + "); " + kAdvice);
  }
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    bodies[i].check();
    for (std::size_t k = 0; k < i; ++k) {
      if (bodies[k].name == bodies[i].name)
        throw BodyError(file + " has two bodies named '" + bodies[i].name + "'; rename one");
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
      out << YAML::Flow << YAML::BeginSeq << exact(led.x()) << exact(led.y()) << exact(led.z())
          << YAML::EndSeq;
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
