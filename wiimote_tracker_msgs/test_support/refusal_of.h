#pragma once

#include <wiimote_tracker_msgs/error.h>

#include <string>

namespace wiimote_tracker {

/// What the Error says that `action` throws; "not refused" if it throws none.
template <typename Action>
std::string refusalOf(const Action& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "not refused";
}

}  // namespace wiimote_tracker
