#include "wiimote_tracker_triangulation/ros/parameter_file.h"

#include <wiimote_tracker_msgs/parameter_reader.h>
#include <yaml-cpp/yaml.h>

namespace wiimote_tracker {
namespace {

using XmlRpc::XmlRpcValue;

/// Quoted scalars, and those that are neither booleans nor numbers, are strings; so are y and n, as
/// rosparam reads them.
XmlRpcValue scalarOf(const YAML::Node& node) {
  const bool is_quoted = node.Tag() == "!";
  bool truth = false;
  int whole = 0;
  double number = 0.0;
  if (!is_quoted && node.Scalar().size() > 1 && YAML::convert<bool>::decode(node, truth))
    return XmlRpcValue(truth);
  if (!is_quoted && YAML::convert<int>::decode(node, whole))
    return XmlRpcValue(whole);
  if (!is_quoted && YAML::convert<double>::decode(node, number))
    return XmlRpcValue(number);
  return XmlRpcValue(node.Scalar());
}

XmlRpcValue valueOf(const YAML::Node& node, const std::string& path) {
  XmlRpcValue value;
  switch (node.Type()) {
    case YAML::NodeType::Scalar:
      return scalarOf(node);
    case YAML::NodeType::Sequence:
      value.setSize(static_cast<int>(node.size()));
      for (std::size_t i = 0; i < node.size(); ++i)
        value[static_cast<int>(i)] = valueOf(node[i], path);
      return value;
    case YAML::NodeType::Map:
      value.begin();  // a struct, even without members
      for (const auto& member : node)
        value[member.first.as<std::string>()] = valueOf(member.second, path);
      return value;
    default:
      throw ParameterError(path + " has a key without a value in line " +
                           std::to_string(node.Mark().line + 1) + ": give it one or remove it");
  }
}

}  // namespace

ParameterTree readParameterTree(const std::string& path, const std::string& node_name) {
  XmlRpcValue empty;
  empty.begin();
  if (path.empty())
    return ParameterTree("parameters", empty);
  try {
    const YAML::Node node = YAML::LoadFile(path);
    if (node.IsNull())
      return ParameterTree(path, empty);
    if (!node.IsMap())
      throw ParameterError(path +
                           " does not hold keys with values: name a file such as those in the "
                           "package's folder config");
    if (const YAML::Node section = node[node_name]; section && section.IsMap())
      return ParameterTree(path + "/" + node_name, valueOf(section, path));
    return ParameterTree(path, valueOf(node, path));
  } catch (const YAML::Exception& e) {
    throw ParameterError(path + " cannot be read as YAML (" + e.what() +
                         "): name a file such as those in the package's folder config");
  }
}

}  // namespace wiimote_tracker
