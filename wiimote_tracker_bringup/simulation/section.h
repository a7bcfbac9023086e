#ifndef WIIMOTE_TRACKER_BRINGUP_SIMULATION_SECTION_H
#define WIIMOTE_TRACKER_BRINGUP_SIMULATION_SECTION_H

#include "description.h"

#include <yaml-cpp/yaml.h>
#include <Eigen/Core>

#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace wiimote_tracker::simulation {

/// One mapping of a description's file. Knows its place, so that errors can name the key in full,
/// and which keys were read, so that a misspelt one is noticed. All throw DescriptionError.
class Section {
 public:
  Section(const YAML::Node& node, const std::string& file, const std::string& path)
      : node_(node), file_(file), path_(path) {
    if (!node_.IsMap())
      throw DescriptionError(file_ + ": " + (path_.empty() ? "the file" : path_) +
                             " must be a mapping of keys to values");
  }

  Section section(const std::string& key) { return Section(get(key), file_, name(key)); }

  bool has(const std::string& key) const { return static_cast<bool>(node_[key]); }

  template <typename T>
  T value(const std::string& key) {
    try {
      return get(key).as<T>();
    } catch (const YAML::Exception&) {
      throw error(key, "has the wrong type");
    }
  }

  template <typename T>
  T value(const std::string& key, const T& default_value) {
    return has(key) ? value<T>(key) : default_value;
  }

  double number(const std::string& key, double minimum, double maximum) {
    const double number = value<double>(key);
    if (minimum <= number && number <= maximum)  // false for NaN
      return number;
    std::ostringstream text;
    text << "is " << number << ", but must be within " << minimum << " and " << maximum;
    throw error(key, text.str());
  }

  double number(const std::string& key, double minimum, double maximum, double default_value) {
    return has(key) ? number(key, minimum, maximum) : default_value;
  }

  Eigen::Vector3d point(const std::string& key) {
    const auto values = value<std::vector<double>>(key);
    if (values.size() != 3)
      throw error(key, "must have three numbers: x, y, z");
    const Eigen::Vector3d point(values[0], values[1], values[2]);
    if (!point.allFinite())
      throw error(key, "must be finite");
    return point;
  }

  /// Names and contents of the mappings in this one, in the order of the file.
  std::vector<std::pair<std::string, Section>> entries() {
    std::vector<std::pair<std::string, Section>> entries;
    for (const auto& entry : node_) {
      const auto key = entry.first.as<std::string>();
      read_.insert(key);
      for (const auto& other : entries) {
        if (other.first == key)
          throw error(key, "is there twice");
      }
      entries.emplace_back(key, Section(entry.second, file_, name(key)));
    }
    if (entries.empty())
      throw DescriptionError(file_ + ": " + path_ + " is empty; describe at least one");
    return entries;
  }

  void refuseUnknown() const {
    for (const auto& entry : node_) {
      const auto key = entry.first.as<std::string>();
      if (read_.count(key) == 0)
        throw error(key, "is not known; remove it or correct its spelling");
    }
  }

  DescriptionError error(const std::string& key, const std::string& what) const {
    return DescriptionError(file_ + ": " + name(key) + " " + what);
  }

 private:
  std::string name(const std::string& key) const { return path_.empty() ? key : path_ + "/" + key; }

  YAML::Node get(const std::string& key) {
    read_.insert(key);
    if (!has(key))
      throw error(key, "is missing");
    return node_[key];
  }

  const YAML::Node node_;
  std::string file_;
  std::string path_;
  std::set<std::string> read_;
};

}  // namespace wiimote_tracker::simulation

#endif  // WIIMOTE_TRACKER_BRINGUP_SIMULATION_SECTION_H
