#pragma once

#include <string>

namespace wiimote_tracker {

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace wiimote_tracker
