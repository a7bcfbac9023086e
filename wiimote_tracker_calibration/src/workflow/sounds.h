#ifndef WIIMOTE_TRACKER_CALIBRATION_WORKFLOW_SOUNDS_H
#define WIIMOTE_TRACKER_CALIBRATION_WORKFLOW_SOUNDS_H

#include "workflow/calibration.h"

#include <cstddef>
#include <string>

namespace wiimote_tracker::workflow {

/// What a person who walks the corners, and sees no screen, should hear.
class Sounds {
 public:
  /// What has happened since the last call: "refused", "captured" (a corner), "enough" (waved),
  /// "solved"; empty: nothing of these.
  std::string heard(const Calibration& calibration);

 private:
  struct State {
    std::size_t refusals = 0;
    std::size_t captures = 0;
    bool enough = false;
    Step step = Step::kIdle;
  };
  State last_;
};

}  // namespace wiimote_tracker::workflow

#endif  // WIIMOTE_TRACKER_CALIBRATION_WORKFLOW_SOUNDS_H
