#pragma once

#include <string>

namespace wiimote_tracker::workflow {

/// The answer to a request: whether it was done, and one sentence: what was done, or why not and
/// what to do.
struct Reply {
  bool success = false;
  std::string message;
};

inline Reply refusal(const std::string& message) {
  return {false, message};
}

}  // namespace wiimote_tracker::workflow
