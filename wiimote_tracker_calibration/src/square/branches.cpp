#include "wiimote_tracker_calibration/square/branches.h"

#include "square/error.h"
#include "square/planar_pose.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace wiimote_tracker::square {

namespace {

// Difference of costs of one camera alone that the other cameras cannot reverse.
constexpr double kClear = 60.0;
// Up to this many ambiguous cameras all 16 combinations are compared; of more, one is changed at a
// time.
constexpr std::size_t kExhaustive = 4;

/// The rig on these branches; which cameras are undecided is open.
std::optional<BranchChoice> evaluate(const SquareModel& model,
                                     const std::vector<std::vector<Branch>>& branches,
                                     const std::vector<std::size_t>& chosen) {
  std::vector<Eigen::Isometry3d> poses;
  for (std::size_t i = 0; i < branches.size(); ++i)
    poses.push_back(branches[i][chosen[i]].world_from_camera);
  BranchChoice combination{model.start(poses), 0.0, chosen, {}};
  const std::optional<double> cost =
      model.refineAll(&combination.state, SquareModel::Precision::kCoarse);
  if (!cost)
    return std::nullopt;
  combination.cost = *cost;
  return combination;
}

std::vector<BranchChoice> allCombinations(const SquareModel& model,
                                          const std::vector<std::vector<Branch>>& branches,
                                          const std::vector<std::size_t>& ambiguous) {
  std::vector<BranchChoice> combinations;
  for (std::size_t bits = 0; bits < std::size_t{1} << ambiguous.size(); ++bits) {
    std::vector<std::size_t> chosen(branches.size(), 0);
    for (std::size_t k = 0; k < ambiguous.size(); ++k)
      chosen[ambiguous[k]] = (bits >> k) & 1U;
    if (auto combination = evaluate(model, branches, chosen))
      combinations.push_back(std::move(*combination));
  }
  return combinations;
}

/// Changes one camera at a time for as long as that helps. Contains the best combination that was
/// found, and all that differ from it in one camera.
std::vector<BranchChoice> singleChanges(const SquareModel& model,
                                        const std::vector<std::vector<Branch>>& branches,
                                        const std::vector<std::size_t>& ambiguous) {
  std::vector<BranchChoice> combinations;
  std::vector<std::size_t> chosen(branches.size(), 0);
  double least = std::numeric_limits<double>::infinity();
  if (auto start = evaluate(model, branches, chosen)) {
    least = start->cost;
    combinations.push_back(std::move(*start));
  }
  // Ends when no change of a camera helps.
  std::size_t without_gain = 0;
  for (std::size_t k = 0; without_gain < ambiguous.size(); k = (k + 1) % ambiguous.size()) {
    std::vector<std::size_t> changed = chosen;
    changed[ambiguous[k]] = 1 - changed[ambiguous[k]];
    auto combination = evaluate(model, branches, changed);
    ++without_gain;
    if (!combination)
      continue;
    if (combination->cost < least) {
      least = combination->cost;
      chosen = changed;
      without_gain = 0;
    }
    combinations.push_back(std::move(*combination));
  }
  return combinations;
}

}  // namespace

std::vector<Branch> findBranches(const SquareModel& model, std::size_t camera) {
  const SquareModel alone = model.only(camera);
  const CameraSightings& seen = alone.sightings().front();
  std::vector<Branch> branches;
  for (const PlanarPose& pose :
       cornerPoses(seen.intrinsics, seen.corners, alone.nominalCorners())) {
    const RigState start = alone.start({pose.world_from_camera});
    RigState probable = start;
    const std::optional<double> cost = alone.refineAll(&probable, SquareModel::Precision::kCoarse);
    const double error = alone.reprojectionError(start, 0);
    if (cost && std::isfinite(error))
      branches.push_back({pose.world_from_camera, error, *cost});
  }
  std::sort(branches.begin(), branches.end(),
            [](const Branch& a, const Branch& b) { return a.cost < b.cost; });
  return branches;
}

BranchChoice chooseBranches(const SquareModel& model,
                            const std::vector<std::vector<Branch>>& branches,
                            double odds) {
  std::vector<std::size_t> ambiguous;
  for (std::size_t i = 0; i < branches.size(); ++i) {
    if (branches[i].size() > 1 && branches[i][1].cost - branches[i][0].cost < kClear)
      ambiguous.push_back(i);
  }
  const std::vector<BranchChoice> combinations = ambiguous.size() <= kExhaustive
                                                     ? allCombinations(model, branches, ambiguous)
                                                     : singleChanges(model, branches, ambiguous);
  if (combinations.empty())
    throw SquareError("the cameras cannot be solved together: capture the corners again");
  const BranchChoice& best =
      *std::min_element(combinations.begin(), combinations.end(),
                        [](const auto& a, const auto& b) { return a.cost < b.cost; });

  BranchChoice choice = best;
  choice.cost = model.refineAll(&choice.state).value_or(best.cost);
  for (const std::size_t i : ambiguous) {
    double other = std::numeric_limits<double>::infinity();
    for (const BranchChoice& combination : combinations) {
      // Two branches may converge to one when the intrinsics are free; then there is no choice.
      if (combination.chosen[i] != best.chosen[i] &&
          !isSamePose(combination.state.cameras[i].world_from_camera,
                      best.state.cameras[i].world_from_camera, model.nominalCorners()))
        other = std::min(other, combination.cost);
    }
    if (other - best.cost < 2.0 * std::log(odds))
      choice.undecided.push_back(i);
  }
  return choice;
}

}  // namespace wiimote_tracker::square
