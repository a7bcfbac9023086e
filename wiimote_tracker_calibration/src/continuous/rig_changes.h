#pragma once

#include "continuous/approach.h"
#include "continuous/proposal.h"

#include <wiimote_tracker_triangulation/geometry/rig.h>

#include <optional>
#include <string>
#include <vector>

namespace wiimote_tracker::continuous {

/// Hash over what continuous calibration changes: the rig's id (geometry::Rig::id()) without masks,
/// which move no point. Empty for no rig.
std::string idWithoutMasks(std::optional<geometry::Rig> rig);

/// The proposed rig with zones, masks and correction of the volume of the rig before, which may
/// have changed meanwhile. The correction belongs to the world, which the other cameras hold.
geometry::Rig appliedRig(const geometry::Rig& proposed, const geometry::Rig& before);

/// The rigs that continuous calibration puts into use, and the way back. Others may replace the rig
/// in use, too, or learn its masks.
class RigChanges {
 public:
  /// To be called with the rig in use at the start, and after anybody has replaced it, as after
  /// revert().
  void follow(const std::optional<geometry::Rig>& in_use);

  /// Whether that rig is still in use.
  bool isInUse(const std::optional<geometry::Rig>& rig) const {
    return idWithoutMasks(rig) == in_use_;
  }

  /// The rig that the one in use approaches, or else itself.
  const geometry::Rig& goal(const geometry::Rig& in_use) const {
    return approach_ ? approach_->goal() : in_use;
  }
  bool isApproaching() const { return approach_.has_value(); }

  /// Whether the rig in use came from revert(). Such a rig is not changed without being asked.
  bool isReverted() const { return in_use_ == reverted_to_; }

  /// @returns the rig to use from now on. Nothing: the rig in use approaches the proposed one.
  std::optional<geometry::Rig> apply(const Proposal& proposal, const geometry::Rig& in_use);

  /// @param stamp of the newest image [s].
  /// @returns the next rig towards the goal. Nothing: there is none yet.
  std::optional<geometry::Rig> step(const geometry::Rig& in_use, double stamp);

  /// @returns the rig from before the last change, now with the masks of the one in use. Nothing:
  /// that one does not come from a change, or from one too long ago.
  std::optional<geometry::Rig> revert(const geometry::Rig& in_use);

 private:
  struct Change {
    std::string id;  // idWithoutMasks() of the newest rig that it has made.
    geometry::Rig before;
  };

  geometry::Rig useChanged(const geometry::Rig& rig);

  std::string in_use_;  // idWithoutMasks()
  std::optional<Approach> approach_;
  std::vector<Change> changes_;
  std::string reverted_to_;  // idWithoutMasks()
};

}  // namespace wiimote_tracker::continuous
