#pragma once

#include "wiimote_tracker_msgs/error.h"

#include <xmlrpcpp/XmlRpcValue.h>

#include <climits>
#include <cmath>
#include <cstddef>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace wiimote_tracker {

/// Parameters of a node or a file: a struct whose members are values, lists or structs again. Keys
/// name a value by its levels, such as "tracks/gate".
class ParameterTree {
 public:
  /// `name`: stands before the keys in error messages, such as the node or the file.
  ParameterTree(const std::string& name, const XmlRpc::XmlRpcValue& values) : name_(name) {
    add(name, values);
  }

  std::string fullName(const std::string& key) const { return name_ + "/" + key; }

  bool has(const std::string& key) const { return values_.count(fullName(key)) > 0; }

  /// False when it is absent or of the wrong type. A whole number may be written as 3 or 3.0.
  template <typename T>
  bool read(const std::string& key, T* value) const {
    const auto found = values_.find(fullName(key));
    return found != values_.end() && convert(found->second, value);
  }

  /// What the key holds, for people: "the text '1e-2'", "2.5", "a group". Long values are cut off.
  std::string describe(const std::string& key) const {
    const auto found = values_.find(fullName(key));
    if (found == values_.end())
      return "nothing";
    const Value& value = found->second;
    if (isGroup(value))
      return "a group";
    std::ostringstream text;
    if (bool flag = false; convert(value, &flag))
      text << std::boolalpha << flag;
    else if (double number = 0.0; convert(value, &number))
      text << number;
    else
      text << value;
    constexpr std::size_t kLongest = 60;  // characters
    std::string shown = text.str();
    if (shown.size() > kLongest)
      shown = shown.substr(0, kLongest) + "...";
    return value.getType() == Value::TypeString ? "the text '" + shown + "'" : shown;
  }

  /// Sets a text. @throws Error: a group of its key is a value.
  void set(const std::string& key, const std::string& value) {
    for (std::size_t end = key.find('/'); end != std::string::npos; end = key.find('/', end + 1)) {
      const auto group = values_.find(fullName(key.substr(0, end)));
      if (group != values_.end() && !isGroup(group->second))
        throw Error(fullName(key) + " cannot be set, since a group of it is a value: remove that");
    }
    values_[fullName(key)] = value;
  }

  /// Full names of all values.
  std::vector<std::string> fullNames() const {
    std::vector<std::string> names;
    for (const auto& [name, value] : values_) {
      if (!isGroup(value))
        names.push_back(name);
    }
    return names;
  }

 private:
  using Value = XmlRpc::XmlRpcValue;

  static bool isGroup(const Value& value) { return value.getType() == Value::TypeStruct; }

  void add(const std::string& name, const Value& value) {
    values_[name] = value;
    if (!isGroup(value))
      return;
    for (const auto& member : value)
      add(name + "/" + member.first, member.second);
  }

  static bool convert(const Value& from, bool* value) {
    if (from.getType() != Value::TypeBoolean)
      return false;
    *value = static_cast<bool>(from);
    return true;
  }

  static bool convert(const Value& from, int* value) {
    double number = 0.0;
    if (!convert(from, &number) || number != std::floor(number) || std::abs(number) > INT_MAX)
      return false;
    *value = static_cast<int>(number);
    return true;
  }

  static bool convert(const Value& from, double* value) {
    if (from.getType() == Value::TypeInt) {
      *value = static_cast<int>(from);
      return true;
    }
    if (from.getType() != Value::TypeDouble)
      return false;
    *value = static_cast<double>(from);
    return true;
  }

  static bool convert(const Value& from, std::string* value) {
    if (from.getType() != Value::TypeString)
      return false;
    *value = static_cast<std::string>(from);
    return true;
  }

  template <typename T>
  static bool convert(const Value& from, std::vector<T>* values) {
    if (from.getType() != Value::TypeArray)
      return false;
    std::vector<T> result(static_cast<std::size_t>(from.size()));
    for (int i = 0; i < from.size(); ++i) {
      T entry;
      if (!convert(from[i], &entry))
        return false;
      result[static_cast<std::size_t>(i)] = entry;
    }
    *values = result;
    return true;
  }

  std::string name_;
  std::map<std::string, Value> values_;  // and groups, by their full names
};

}  // namespace wiimote_tracker
