#include "wiimote_tracker_triangulation/ros/parameter_file.h"

#include <wiimote_tracker_msgs/parameter_reader.h>
#include <wiimote_tracker_msgs/text.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cstdio>
#include <set>
#include <sstream>
#include <vector>

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

/// As a group, to which members can be added.
XmlRpcValue* groupIn(XmlRpcValue* value) {
  if (value->getType() != XmlRpcValue::TypeStruct)
    value->clear();
  value->begin();  // a struct, even without members
  return value;
}

/// Takes what the file says. A key may name several levels, as for rosparam: "tracks/gate".
void take(const YAML::Node& node, const std::string& path, XmlRpcValue* value) {
  switch (node.Type()) {
    case YAML::NodeType::Scalar:
      *value = scalarOf(node);
      return;
    case YAML::NodeType::Sequence:
      value->setSize(static_cast<int>(node.size()));
      for (std::size_t i = 0; i < node.size(); ++i)
        take(node[i], path, &(*value)[static_cast<int>(i)]);
      return;
    case YAML::NodeType::Map:
      groupIn(value);
      for (const auto& member : node) {
        XmlRpcValue* place = value;
        std::istringstream levels(member.first.as<std::string>());
        for (std::string level; std::getline(levels, level, '/');) {
          if (!level.empty())  // an absolute name
            place = &(*groupIn(place))[level];
        }
        take(member.second, path, place);
      }
      return;
    default:
      throw ParameterError(path + " has a key without a value in line " +
                           std::to_string(node.Mark().line + 1) + ": give it one or remove it");
  }
}

/// Of the launch files, which a file of `parameters:=` groups its values by.
bool isNode(const std::string& name) {
  static const std::set<std::string> kNodes{"calibration",    "coverage",      "drivers",
                                            "first_drivers",  "manager",       "second_drivers",
                                            "simulated_hand", "simulated_rig", "triangulation"};
  return kNodes.count(name) > 0;
}

/// The node's group of a file for `parameters:=`. Says what nobody reads.
XmlRpcValue groupOf(const std::string& node_name, const std::string& path, XmlRpcValue* all) {
  std::vector<std::string> unread;
  for (const auto& member : *all) {
    if (!isNode(member.first))
      unread.push_back(member.first);
  }
  if (!unread.empty())
    std::fprintf(stderr,
                 "%s: no node is called %s: write parameters of %s below that name, unless a node "
                 "of your own is called so.\n",
                 path.c_str(), joined(unread).c_str(), node_name.c_str());
  XmlRpcValue& own = (*all)[node_name];
  if (own.getType() != XmlRpcValue::TypeStruct)
    std::fprintf(stderr, "%s has no parameters of %s: write them as \"%s: {parameter: value}\".\n",
                 path.c_str(), node_name.c_str(), node_name.c_str());
  return *groupIn(&own);
}

}  // namespace

ParameterTree readParameterTree(const std::string& path, const std::string& node_name) {
  XmlRpcValue values;
  groupIn(&values);
  if (path.empty())
    return ParameterTree("parameters", values);
  try {
    const std::vector<YAML::Node> documents = YAML::LoadAllFromFile(path);
    if (documents.size() > 1)
      throw ParameterError(path + " holds several YAML documents: remove the lines \"---\"");
    const bool is_empty = documents.empty() || documents[0].IsNull();
    if (!is_empty && !documents[0].IsMap())
      throw ParameterError(path +
                           " does not hold keys with values: name a file such as those in the "
                           "package's folder config");
    if (!is_empty)
      take(documents[0], path, &values);
  } catch (const YAML::Exception& e) {
    throw ParameterError(path + " cannot be read as YAML (" + e.what() +
                         "): name a file such as those in the package's folder config");
  }
  const bool has_groups = std::any_of(values.begin(), values.end(), [](const auto& member) {
    return isNode(member.first) && member.second.getType() == XmlRpcValue::TypeStruct;
  });
  return has_groups || values.size() == 0
             ? ParameterTree(path + "/" + node_name, groupOf(node_name, path, &values))
             : ParameterTree(path, values);
}

}  // namespace wiimote_tracker
