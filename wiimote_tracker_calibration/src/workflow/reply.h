#ifndef WIIMOTE_TRACKER_CALIBRATION_WORKFLOW_REPLY_H
#define WIIMOTE_TRACKER_CALIBRATION_WORKFLOW_REPLY_H

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

#endif  // WIIMOTE_TRACKER_CALIBRATION_WORKFLOW_REPLY_H
