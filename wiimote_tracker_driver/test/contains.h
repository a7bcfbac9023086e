#ifndef WIIMOTE_TRACKER_DRIVER_TEST_CONTAINS_H
#define WIIMOTE_TRACKER_DRIVER_TEST_CONTAINS_H

#include <string>

namespace wiimote_tracker {

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace wiimote_tracker

#endif  // WIIMOTE_TRACKER_DRIVER_TEST_CONTAINS_H
