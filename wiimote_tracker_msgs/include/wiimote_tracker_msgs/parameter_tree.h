#ifndef WIIMOTE_TRACKER_MSGS_PARAMETER_TREE_H
#define WIIMOTE_TRACKER_MSGS_PARAMETER_TREE_H

#include "wiimote_tracker_msgs/error.h"

#include <xmlrpcpp/XmlRpcValue.h>

#include <climits>
#include <cmath>
#include <cstddef>
#include <sstream>
#include <string>
#include <vector>

namespace wiimote_tracker {

/// Parameters of a node or a file: a struct whose members are values, lists or structs again. Keys
/// name a value by its levels, such as "tracks/gate".
class ParameterTree {
 public:
  /// `name`: stands before the keys in error messages, such as the node or the file.
  ParameterTree(const std::string& name, const XmlRpc::XmlRpcValue& values)
      : name_(name), values_(values) {}

  std::string fullName(const std::string& key) const { return name_ + "/" + key; }

  bool has(const std::string& key) const {
    Value value;
    return find(key, &value);
  }

  /// False when it is absent or of the wrong type. A whole number may be written as 3 or 3.0.
  template <typename T>
  bool read(const std::string& key, T* value) const {
    Value found;
    return find(key, &found) && convert(found, value);
  }

  /// What the key holds, for people: "the text '1e-2'", "2.5", "a group". Long values are cut off.
  std::string describe(const std::string& key) const {
    Value value;
    if (!find(key, &value))
      return "nothing";
    if (value.getType() == Value::TypeStruct)
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

  /// Sets a text, and makes the groups of its key. @throws Error: one of them is a value.
  void set(const std::string& key, const std::string& value) {
    Value* place = &values_;
    std::istringstream levels(key);
    for (std::string level; std::getline(levels, level, '/');) {
      if (place->valid() && place->getType() != Value::TypeStruct)
        throw Error(fullName(key) + " cannot be set, since a group of it is a value: remove that");
      place = &(*place)[level];
    }
    *place = value;
  }

  /// Full names of all values.
  std::vector<std::string> fullNames() const {
    std::vector<std::string> names;
    appendNames(name_, values_, &names);
    return names;
  }

 private:
  using Value = XmlRpc::XmlRpcValue;

  bool find(const std::string& key, Value* found) const {
    *found = values_;
    std::istringstream levels(key);
    for (std::string level; std::getline(levels, level, '/');) {
      if (found->getType() != Value::TypeStruct || !found->hasMember(level))
        return false;
      const Value inner = (*found)[level];
      *found = inner;
    }
    return true;
  }

  static bool convert(Value& from, bool* value) {
    if (from.getType() != Value::TypeBoolean)
      return false;
    *value = static_cast<bool>(from);
    return true;
  }

  static bool convert(Value& from, int* value) {
    double number = 0.0;
    if (!convert(from, &number) || number != std::floor(number) || std::abs(number) > INT_MAX)
      return false;
    *value = static_cast<int>(number);
    return true;
  }

  static bool convert(Value& from, double* value) {
    if (from.getType() == Value::TypeInt) {
      *value = static_cast<int>(from);
      return true;
    }
    if (from.getType() != Value::TypeDouble)
      return false;
    *value = static_cast<double>(from);
    return true;
  }

  static bool convert(Value& from, std::string* value) {
    if (from.getType() != Value::TypeString)
      return false;
    *value = static_cast<std::string>(from);
    return true;
  }

  template <typename T>
  static bool convert(Value& from, std::vector<T>* values) {
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

  static void appendNames(const std::string& prefix,
                          const Value& value,
                          std::vector<std::string>* names) {
    if (value.getType() != Value::TypeStruct) {
      names->push_back(prefix);
      return;
    }
    for (const auto& member : value)
      appendNames(prefix + "/" + member.first, member.second, names);
  }

  std::string name_;
  Value values_;
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_MSGS_PARAMETER_TREE_H
