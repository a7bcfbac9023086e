#include "continuous/proposal.h"

namespace wiimote_tracker::continuous {

namespace {

/// Replaces what an earlier change has added to the verdict.
std::string verdictWith(const std::string& verdict, const std::string& change) {
  const std::string kSince = "; since then ";
  return verdict.substr(0, verdict.find(kSince)) + kSince + change;
}

}  // namespace

Proposal proposalOf(Cause cause,
                    const std::vector<std::string>& cameras,
                    const geometry::Rig& before,
                    const geometry::Rig& rig,
                    const std::string& message,
                    const std::vector<capture::Image>& checked) {
  Proposal proposal{cause, cameras, rig, 0.0, message, {}};
  proposal.rig.solved_at = checked.back().stamp;
  proposal.rig.verdict = verdictWith(before.verdict, message);
  return proposal;
}

}  // namespace wiimote_tracker::continuous
