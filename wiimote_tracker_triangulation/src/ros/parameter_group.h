#ifndef WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_PARAMETER_GROUP_H
#define WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_PARAMETER_GROUP_H

#include <wiimote_tracker_msgs/parameter_reader.h>

#include <cstddef>
#include <string>

namespace wiimote_tracker {

/// Reads parameters below one name into variables that hold their defaults. All functions throw
/// ParameterError.
class ParameterGroup {
 public:
  /// `name`: such as "tracks"; empty: the node's parameters themselves.
  ParameterGroup(ParameterReader* reader, const std::string& name)
      : reader_(reader), prefix_(name.empty() ? "" : name + "/") {}

  void read(const std::string& key, double* value, double minimum, double maximum) const {
    *value = reader_->bounded(prefix_ + key, *value, minimum, maximum);
  }

  void read(const std::string& key, int* value, int minimum, int maximum) const {
    *value = reader_->bounded(prefix_ + key, *value, minimum, maximum);
  }

  void read(const std::string& key, std::size_t* value, int minimum, int maximum) const {
    *value = static_cast<std::size_t>(
        reader_->bounded(prefix_ + key, static_cast<int>(*value), minimum, maximum));
  }

  /// A string, a boolean or a list.
  template <typename T>
  void read(const std::string& key, T* value) const {
    *value = reader_->optional(prefix_ + key, *value);
  }

 private:
  ParameterReader* reader_;
  std::string prefix_;
};

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_TRIANGULATION_SRC_ROS_PARAMETER_GROUP_H
