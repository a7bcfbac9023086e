#pragma once

#include "workflow/calibration.h"

#include <cstddef>
#include <string>
#include <utility>

namespace wiimote_tracker::workflow {

/// What a person who walks the corners, and sees no screen, should hear.
class Sounds {
 public:
  /// What has happened since the last call: "refused", "captured" (a corner), "enough" (waved),
  /// "solved"; empty: nothing of these.
  std::string heard(const Calibration& calibration) {
    const Step step = calibration.step();
    const State now = {calibration.refusals(), calibration.captures(),
                       step == Step::kWaving && calibration.wave()->report().enough(), step};
    const State before = std::exchange(last_, now);
    if (now.refusals > before.refusals)
      return "refused";
    if (now.captures > before.captures)
      return "captured";
    if (now.enough && !before.enough)
      return "enough";
    return step == Step::kSolved && before.step == Step::kSolving ? "solved" : "";
  }

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
