#include "body/bodies_file.h"

#include "wiimote_tracker_triangulation/geometry/atomic_file.h"
#include "wiimote_tracker_triangulation/geometry/yaml_map.h"

#include <wiimote_tracker_msgs/text.h>

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>

namespace wiimote_tracker::body {
namespace {

constexpr const char* kFormat = "wiimote_tracker_bodies";
constexpr int kFormatVersion = 1;
constexpr const char* kAdvice = "correct the file";

ImuMount readImu(geometry::YamlMap map) {
  ImuMount imu;
  imu.topic = map.get<std::string>("topic");
  const auto isOfName = [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '/'; };
  if (imu.topic.empty() || std::isdigit(static_cast<unsigned char>(imu.topic.front())) ||
      imu.topic.front() == '_' || !std::all_of(imu.topic.begin(), imu.topic.end(), isOfName))
    throw map.error("topic", "is not the name of a topic");
  imu.body_from_imu.translation() = map.vector("translation");
  const std::vector<double> q = map.numbers("quaternion_xyzw", 4);
  const Eigen::Quaterniond rotation(q[3], q[0], q[1], q[2]);
  if (!(std::fabs(rotation.norm() - 1.0) < 0.01))
    throw map.error("quaternion_xyzw", "has not the length 1");
  imu.body_from_imu.linear() = rotation.normalized().toRotationMatrix();
  imu.clock_offset = map.bounded("clock_offset", -1e9, 1e9, imu.clock_offset);
  return imu;
}

void writeImu(const ImuMount& imu, YAML::Emitter* out) {
  const Eigen::Vector3d translation = imu.body_from_imu.translation();
  const Eigen::Quaterniond rotation(imu.body_from_imu.linear());
  *out << "imu" << YAML::BeginMap;
  *out << "topic" << YAML::DoubleQuoted << imu.topic;
  *out << "translation" << YAML::Flow << exactNumbers(translation);
  *out << "quaternion_xyzw" << YAML::Flow << exactNumbers(rotation.coeffs());
  *out << "clock_offset" << exactNumber(imu.clock_offset);
  *out << YAML::EndMap;
}

Constellation readBody(geometry::YamlMap map) {
  Constellation body;
  body.name = map.get<std::string>("name");
  for (const std::vector<double>& led : map.rows("leds", 3, "x, y, z"))
    body.leds.emplace_back(led[0], led[1], led[2]);
  body.labels = map.get("labels", body.labels);
  if (map.has("imu"))
    body.imu = readImu(map.map("imu"));
  return body;
}

Constellation readMarkerPositions(geometry::YamlMap map, const std::string& file) {
  Constellation body;
  body.name = std::filesystem::path(file).stem().string();
  for (geometry::YamlMap& led : map.maps("marker_positions"))
    body.leds.emplace_back(led.get<double>("x"), led.get<double>("y"), led.get<double>("z"));
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
  }
  map.refuseUnknown();
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
  out << "format" << kFormat;
  out << "version" << kFormatVersion;
  out << "bodies" << YAML::BeginSeq;
  for (const Constellation& body : bodies) {
    out << YAML::BeginMap;
    out << "name" << YAML::DoubleQuoted << body.name;
    out << "leds" << YAML::Comment("x, y, z [m]") << YAML::BeginSeq;
    for (const Eigen::Vector3d& led : body.leds)
      out << YAML::Flow << exactNumbers(led);
    out << YAML::EndSeq;
    if (!body.labels.empty()) {
      out << "labels" << YAML::Flow << YAML::BeginSeq;
      for (const std::string& label : body.labels)
        out << YAML::DoubleQuoted << label;
      out << YAML::EndSeq;
    }
    if (body.imu)
      writeImu(*body.imu, &out);
    out << YAML::EndMap;
  }
  out << YAML::EndSeq << YAML::EndMap;
  geometry::writeFileAtomically(file, std::string(out.c_str()) + "\n");
}

}  // namespace wiimote_tracker::body
