#include "workflow/sounds.h"

#include <utility>

namespace wiimote_tracker::workflow {

std::string Sounds::heard(const Calibration& calibration) {
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

}  // namespace wiimote_tracker::workflow
