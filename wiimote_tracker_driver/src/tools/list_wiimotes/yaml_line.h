#ifndef WIIMOTE_TRACKER_DRIVER_LIST_WIIMOTES_YAML_LINE_H
#define WIIMOTE_TRACKER_DRIVER_LIST_WIIMOTES_YAML_LINE_H

#include <optional>
#include <string>

namespace wiimote_tracker::list_wiimotes {

/// A line 'key: value', or 'key:' alone, of a YAML file, taken apart.
struct Assignment {
  std::string key;
  std::string before;  ///< All before the value.
  std::string value;   ///< Without quotes; empty when there is none.
  std::string after;   ///< All behind it.
};

/// Nothing for a line of another form, or with a value that is more than a plain or quoted text.
std::optional<Assignment> parseAssignment(const std::string& line);

bool isBlankOrComment(const std::string& text);

}  // namespace wiimote_tracker::list_wiimotes

#endif  // WIIMOTE_TRACKER_DRIVER_LIST_WIIMOTES_YAML_LINE_H
