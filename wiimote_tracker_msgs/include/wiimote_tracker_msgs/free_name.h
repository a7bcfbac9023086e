#pragma once

#include <algorithm>
#include <cctype>
#include <string>

namespace wiimote_tracker {

/// What isFreeName() asks for.
constexpr const char* kFreeName = "1 to 100 bytes, none of them a control character";

/// Whether a text can be a name that people choose as they like, such as of a zone or a gesture.
inline bool isFreeName(const std::string& text) {
  return !text.empty() && text.size() <= 100 && std::none_of(text.begin(), text.end(), [](char c) {
    return std::iscntrl(static_cast<unsigned char>(c)) != 0;
  });
}

}  // namespace wiimote_tracker
