#pragma once

#include "wiimote_tracker_msgs/error.h"
#include "wiimote_tracker_msgs/parameter_tree.h"
#include "wiimote_tracker_msgs/text.h"

#include <ros/node_handle.h>

#include <algorithm>
#include <cstddef>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace wiimote_tracker {

/// A parameter is missing, of the wrong type, out of range, or unknown; what() names it in full.
struct ParameterError : Error {
  using Error::Error;
};

/// Reads a node's parameters, or those in a file, and refuses what it does not understand, so that
/// a typing error in a YAML file is an error and not a default. Every read names a key below the
/// given namespace; refuseUnknown() then throws for keys that are set there and that nobody read.
class ParameterReader {
 public:
  /// The parameters as they are set now.
  explicit ParameterReader(const ros::NodeHandle& nh) : ParameterReader(treeOf(nh)) {}

  /// Reads what a file says instead.
  explicit ParameterReader(const ParameterTree& tree) : tree_(tree) {}

  /// The key in full, as errors call it.
  std::string nameOf(const std::string& key) const { return tree_.fullName(key); }

  /// @throws ParameterError when the key is absent or of the wrong type.
  template <typename T>
  T required(const std::string& key, const std::string& what_to_set) {
    used_.insert(nameOf(key));
    if (!tree_.has(key))
      throw ParameterError("set " + nameOf(key) + ": " + what_to_set);
    return get<T>(key);
  }

  /// @throws ParameterError when the key is present with the wrong type.
  template <typename T>
  T optional(const std::string& key, const T& default_value) {
    used_.insert(nameOf(key));
    defaults_[key] = textOf(default_value);
    return tree_.has(key) ? get<T>(key) : default_value;
  }

  /// A number within [minimum, maximum]. @throws ParameterError when it is not.
  template <typename T>
  T bounded(const std::string& key, T default_value, T minimum, T maximum) {
    ranges_[key] = {static_cast<double>(minimum), static_cast<double>(maximum)};
    const T value = optional<T>(key, default_value);
    if (minimum <= value && value <= maximum)  // false for NaN
      return value;
    std::ostringstream text;
    text << nameOf(key) << " is " << value << ", but must be within " << minimum << " and "
         << maximum;
    throw ParameterError(text.str());
  }

  /// A number within [minimum, maximum], into a variable that holds its default.
  /// @throws ParameterError when it is not.
  void read(const std::string& key, double* value, double minimum, double maximum) {
    *value = bounded(key, *value, minimum, maximum);
  }
  void read(const std::string& key, int* value, int minimum, int maximum) {
    *value = bounded(key, *value, minimum, maximum);
  }
  void read(const std::string& key, std::size_t* value, int minimum, int maximum) {
    *value = static_cast<std::size_t>(bounded(key, static_cast<int>(*value), minimum, maximum));
  }

  /// A text, a boolean or a list, into a variable that holds its default.
  /// @throws ParameterError when it is of another type.
  template <typename T>
  void read(const std::string& key, T* value) {
    *value = optional<T>(key, *value);
  }

  /// One of the given words. @throws ParameterError when it is another.
  std::string choice(const std::string& key,
                     const std::string& default_value,
                     const std::vector<std::string>& words) {
    choices_[key] = words;
    const std::string value = optional<std::string>(key, default_value);
    if (std::find(words.begin(), words.end(), value) == words.end())
      throw ParameterError(nameOf(key) + " is '" + value +
                           "', but must be one of: " + joined(words));
    return value;
  }

  /// Full names of all values that are set.
  std::vector<std::string> fullNames() const { return tree_.fullNames(); }

  /// Defaults as YAML, and ranges and words of the keys that were read with them, for checks of
  /// documents.
  const std::map<std::string, std::string>& defaults() const { return defaults_; }
  const std::map<std::string, std::pair<double, double>>& ranges() const { return ranges_; }
  const std::map<std::string, std::vector<std::string>>& choices() const { return choices_; }

  /// @throws ParameterError naming every key below the namespace that was not read.
  void refuseUnknown() const {
    std::vector<std::string> unknown;
    for (const std::string& name : fullNames()) {
      if (used_.count(name) == 0)
        unknown.push_back(name);
    }
    if (!unknown.empty())
      throw ParameterError("unknown parameter " + joined(unknown) +
                           ": remove it or correct its spelling");
  }

 private:
  static ParameterTree treeOf(const ros::NodeHandle& nh) {
    XmlRpc::XmlRpcValue values;
    if (!nh.getParam(nh.getNamespace(), values))
      values.begin();  // a struct without members
    return ParameterTree(nh.getNamespace(), values);
  }

  template <typename T>
  T get(const std::string& key) const {
    T value;
    if (!tree_.read(key, &value))
      throw ParameterError(nameOf(key) + " has the wrong type: expected " + typeName(T()) +
                           ", but it is " + tree_.describe(key));
    return value;
  }

  static std::string typeName(double) { return "a number"; }
  static std::string typeName(int) { return "a whole number"; }
  static std::string typeName(bool) { return "true or false"; }
  static std::string typeName(const std::string&) { return "a text (in quotes)"; }
  template <typename T>
  static std::string typeName(const std::vector<T>&) {
    return "a list, each entry " + typeName(T());
  }

  static std::string textOf(bool value) { return value ? "true" : "false"; }
  static std::string textOf(const std::string& value) { return value; }
  template <typename T>
  static std::string textOf(const T& value) {
    std::ostringstream text;
    text.precision(17);
    text << value;
    return text.str();
  }
  template <typename T>
  static std::string textOf(const std::vector<T>& values) {
    std::string list;
    for (const T& value : values)
      list += (list.empty() ? "" : ", ") + textOf(value);
    return "[" + list + "]";
  }

  ParameterTree tree_;
  std::set<std::string> used_;
  std::map<std::string, std::string> defaults_;
  std::map<std::string, std::pair<double, double>> ranges_;
  std::map<std::string, std::vector<std::string>> choices_;
};

}  // namespace wiimote_tracker
