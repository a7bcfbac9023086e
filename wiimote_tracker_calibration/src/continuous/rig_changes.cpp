#include "continuous/rig_changes.h"

#include "capture/masks.h"

#include <cstddef>

namespace wiimote_tracker::continuous {

namespace {

constexpr std::size_t kMostChanges = 100;  // that can be reverted

}  // namespace

std::string idWithoutMasks(std::optional<geometry::Rig> rig) {
  if (!rig)
    return "";
  for (geometry::RigCamera& camera : rig->cameras)
    camera.masks.clear();
  return rig->id();
}

geometry::Rig appliedRig(const geometry::Rig& proposed, const geometry::Rig& before) {
  geometry::Rig rig = capture::withMasks(proposed, capture::masksOf(before));
  rig.zones = before.zones;
  rig.remap = before.remap;
  if (rig.remap && rig.remap->rig_id == before.id())
    rig.remap->rig_id = rig.id();
  return rig;
}

void RigChanges::follow(const std::optional<geometry::Rig>& in_use) {
  if (isInUse(in_use))
    return;
  approach_.reset();  // Someone has replaced the rig.
  in_use_ = idWithoutMasks(in_use);
}

std::optional<geometry::Rig> RigChanges::apply(const Proposal& proposal,
                                               const geometry::Rig& in_use) {
  changes_.push_back({in_use_, in_use});
  if (changes_.size() > kMostChanges)
    changes_.erase(changes_.begin());
  const geometry::Rig rig = appliedRig(proposal.rig, in_use);
  if (movementOf(in_use, rig, proposal.places) > Approach::kLongestStep) {
    approach_.emplace(rig, proposal.places);
    return std::nullopt;
  }
  if (!proposal.places.empty())
    approach_.reset();  // The way to this rig is a single step.
  if (!approach_)
    return useChanged(rig);
  // On the way to another rig, only the cameras that were knocked change at once.
  return useChanged(appliedRig(approach_->changeGoal(rig, proposal.cameras, in_use), in_use));
}

std::optional<geometry::Rig> RigChanges::step(const geometry::Rig& in_use, double stamp) {
  if (!approach_)
    return std::nullopt;
  const auto next = approach_->step(in_use, stamp);
  if (!next)
    return std::nullopt;
  if (approach_->isReached())
    approach_.reset();
  return useChanged(appliedRig(*next, in_use));
}

std::optional<geometry::Rig> RigChanges::revert(const geometry::Rig& in_use) {
  if (changes_.empty() || idWithoutMasks(in_use) != changes_.back().id)
    return std::nullopt;
  const geometry::Rig before = appliedRig(changes_.back().before, in_use);
  changes_.pop_back();
  approach_.reset();  // Perhaps before its first step.
  reverted_to_ = idWithoutMasks(before);
  return before;
}

geometry::Rig RigChanges::useChanged(const geometry::Rig& rig) {
  in_use_ = changes_.back().id = idWithoutMasks(rig);
  return rig;
}

}  // namespace wiimote_tracker::continuous
