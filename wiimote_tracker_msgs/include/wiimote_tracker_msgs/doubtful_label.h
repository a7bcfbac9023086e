#pragma once

#include <string>

namespace wiimote_tracker {

/// A label that is right with a smaller probability is doubtful.
constexpr double kDoubtfulLabel = 0.8;

/// A label as people read it. @param confidence label_confidence of TrackedPoint.msg
inline std::string shownLabel(const std::string& label, double confidence) {
  return label + (confidence < kDoubtfulLabel ? "?" : "");
}

}  // namespace wiimote_tracker
