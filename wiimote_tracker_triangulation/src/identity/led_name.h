#pragma once

#include <cstdint>
#include <string>

namespace wiimote_tracker::identity {

constexpr char kNumbered[] = "led_";  // then the number of the track

/// Name of an LED without a label.
/// @param id of its track
inline std::string numberedName(std::uint32_t id) {
  return kNumbered + std::to_string(id);
}

/// Whether an LED without a label may have this name.
inline bool isNumbered(const std::string& name) {
  const std::string prefix = kNumbered;
  return name.compare(0, prefix.size(), prefix) == 0 && name.size() > prefix.size() &&
         name.find_first_not_of("0123456789", prefix.size()) == std::string::npos;
}

}  // namespace wiimote_tracker::identity
