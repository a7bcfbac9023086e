#ifndef WIIMOTE_TRACKER_TRIANGULATION_GEOMETRY_YAML_MAP_H
#define WIIMOTE_TRACKER_TRIANGULATION_GEOMETRY_YAML_MAP_H

#include "wiimote_tracker_triangulation/geometry/error.h"

#include <yaml-cpp/yaml.h>

#include <set>
#include <string>
#include <vector>

namespace wiimote_tracker::geometry {

/// A map of a YAML file that is read strictly: a key that is missing, of the wrong type, there
/// twice, or never asked for is an error that names the file and the key.
class YamlMap {
 public:
  /// What to do about a rig file that cannot be read.
  static constexpr const char* kRigAdvice = "restore the file from its backup or calibrate again";

  /// `where`: file, and path of this map in it, and `advice`: what to do, for the messages.
  /// @throws RigFileError: not a map.
  YamlMap(const YAML::Node& node, const std::string& where, const char* advice = kRigAdvice)
      : node_(node), where_(where), advice_(advice) {
    if (!node_.IsMap())
      throw RigFileError(where_ + " is not a map of keys and values; " + advice_);
    std::set<std::string> keys;
    for (const auto& entry : node_) {
      if (!entry.first.IsScalar())
        throw RigFileError(where_ + " has a key that is not a word; " + advice_);
      if (!keys.insert(entry.first.Scalar()).second)
        throw RigFileError(at(entry.first.Scalar()) + " is there twice; " + advice_);
    }
  }

  /// @throws RigFileError: missing, of the wrong type.
  template <typename T>
  T get(const std::string& key) {
    try {
      return value(key).template as<T>();
    } catch (const YAML::Exception&) {
      throw RigFileError(at(key) + " has a value of the wrong kind; " + advice_);
    }
  }

  /// A whole number within [minimum, maximum].
  template <typename T>
  T whole(const std::string& key, long long minimum, long long maximum) {
    const auto number = get<long long>(key);
    if (number < minimum || number > maximum)
      throw RigFileError(at(key) + " is out of range; " + advice_);
    return static_cast<T>(number);
  }

  /// Whether an optional key is there.
  bool has(const std::string& key) const { return node_[key].IsDefined(); }

  YamlMap map(const std::string& key) { return YamlMap(value(key), at(key), advice_); }

  std::vector<YamlMap> maps(const std::string& key) {
    const YAML::Node list = value(key);
    if (!list.IsSequence())
      throw RigFileError(at(key) + " is not a list; " + advice_);
    std::vector<YamlMap> result;
    for (std::size_t i = 0; i < list.size(); ++i)
      result.emplace_back(list[i], at(key) + "[" + std::to_string(i) + "]", advice_);
    return result;
  }

  std::vector<double> numbers(const std::string& key) { return get<std::vector<double>>(key); }

  /// @throws RigFileError: a key that nobody asked for.
  void refuseUnknown() const {
    for (const auto& entry : node_) {
      if (!asked_.count(entry.first.Scalar()))
        throw RigFileError(at(entry.first.Scalar()) + " is an unknown key; " + advice_);
    }
  }

  std::string at(const std::string& key) const { return where_ + ": " + key; }

 private:
  YAML::Node value(const std::string& key) {
    asked_.insert(key);
    // Through a const node: the other operator[] would insert the key.
    const YAML::Node& node = node_;
    const YAML::Node found = node[key];
    if (!found.IsDefined())
      throw RigFileError(at(key) + " is missing; " + advice_);
    return found;
  }

  YAML::Node node_;
  std::string where_;
  const char* advice_;
  std::set<std::string> asked_;
};

}  // namespace wiimote_tracker::geometry

#endif  // WIIMOTE_TRACKER_TRIANGULATION_GEOMETRY_YAML_MAP_H
