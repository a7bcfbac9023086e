#include "parameter_file.h"

#include <wiimote_tracker_msgs/parameter_reader.h>
#include <yaml-cpp/yaml.h>

namespace wiimote_tracker {

namespace {

using XmlRpc::XmlRpcValue;

template <typename T>
bool isA(const YAML::Node& node, XmlRpcValue* value) {
  T read;
  if (!YAML::convert<T>::decode(node, read))
    return false;
  *value = XmlRpcValue(read);
  return true;
}

XmlRpcValue toValue(const YAML::Node& node) {
  XmlRpcValue value;
  if (node.IsMap()) {
    value.begin();  // makes it a struct
    for (const auto& entry : node)
      value[entry.first.as<std::string>()] = toValue(entry.second);
  } else if (node.IsSequence()) {
    value.setSize(static_cast<int>(node.size()));
    for (std::size_t i = 0; i < node.size(); ++i)
      value[static_cast<int>(i)] = toValue(node[i]);
  } else {
    const bool is_quoted = node.Tag() == "!";
    if (is_quoted ||
        !(isA<int>(node, &value) || isA<double>(node, &value) || isA<bool>(node, &value)))
      value = XmlRpcValue(node.as<std::string>());
  }
  return value;
}

}  // namespace

ParameterTree readParameterTree(const std::string& path) {
  try {
    const YAML::Node file = YAML::LoadFile(path);
    if (!file.IsMap())
      throw ParameterError(path + " has no parameters: name a file like config/calibration.yaml");
    return ParameterTree(path, toValue(file));
  } catch (const YAML::Exception& error) {
    throw ParameterError(path + " cannot be read: " + error.what() +
                         "; name a file like config/calibration.yaml");
  }
}

}  // namespace wiimote_tracker
