#pragma once

#include "continuous/proposal.h"
#include "samples/verdict.h"
#include "workflow/calibration.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker::workflow {

/// The one thing that a person is to do next. Fields as the next_... of CalibrationStatus.msg.
struct NextStep {
  std::string title;                    ///< In one or two words, to be read from afar.
  std::string sentence;                 ///< In full.
  std::string request{};                ///< That does it; empty: there is nothing to request.
  std::string label{};                  ///< Of a key or a button for it.
  std::optional<std::size_t> corner{};  ///< To be captured again, 0..3.
};

/// Cameras that are no longer as the rig in use has them.
struct Findings {
  std::vector<std::string> changed;      ///< What is found of them is in their health.
  std::string remedy{};                  ///< What to do about these.
  std::vector<std::string> correctable;  ///< By what continuous calibration proposes.
  continuous::Cause cause{};             ///< Of that proposal.
  std::string silent;  ///< Which sent no image since the start, and what to do; empty: none.
};

/// @param verdict of the rig in use, if there is one.
NextStep nextStep(const Calibration& calibration,
                  const samples::Verdict& verdict,
                  const Findings& findings);

}  // namespace wiimote_tracker::workflow
