#include "wiimote_tracker_calibration/square/solve_square.h"

#include "wiimote_tracker_calibration/square/branches.h"
#include "wiimote_tracker_calibration/square/error.h"
#include "wiimote_tracker_calibration/square/expected_error.h"

#include "usable_cameras.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

namespace wiimote_tracker::square {

namespace {

// Residuals this many times larger than expected are reported, and refused.
constexpr double kWarnRatio = 2.0;
constexpr double kRefuseRatio = 4.0;
// A lens that must be farther than this from where it started is no explanation [standard
// deviations].
constexpr double kLensLimit = 5.0;
// Gravity farther from the floor's normal than this is a contradiction [standard deviations].
constexpr double kGravityLimit = 5.0;
// A calibration that puts points off by more than this share of the square's side is reported.
constexpr double kErrorLimit = 0.03;

std::string number(const char* format, double value) {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::vector<std::vector<Branch>> branchesOfAll(const RigModel& model) {
  std::vector<std::vector<Branch>> branches;
  for (std::size_t i = 0; i < model.sightings().size(); ++i) {
    branches.push_back(findBranches(model, i));
    if (branches.back().empty())
      throw SquareError("no place explains what " + model.sightings()[i].name +
                        " saw of the square: check its starting intrinsics and the sides of the "
                        "square, and capture the corners again");
  }
  return branches;
}

void refuseUndecided(const RigModel& model,
                     const std::vector<std::vector<Branch>>& branches,
                     const BranchChoice& choice) {
  if (choice.undecided.empty())
    return;
  const std::size_t i = choice.undecided.front();
  const std::vector<Branch>& both = branches[i];
  const double apart =
      (both[0].world_from_camera.translation() - both[1].world_from_camera.translation()).norm();
  throw SquareError(
      model.sightings()[i].name + " can stand in two places, " + number("%.2f m", apart) +
      " apart, that explain what it saw (to " + number("%.2f", both[0].reprojection_error) +
      " and " + number("%.2f px", both[1].reprojection_error) +
      "), and nothing tells which: let it look at the square more from the side or from nearer, "
      "use a larger square, or connect its accelerometer");
}

/// Ratio of the residuals to what the uncertainties let expect; about 1 when all is well.
double misfit(double cost, const RigModel& model) {
  return std::sqrt(cost / model.degreesOfFreedom());
}

/// Whether the best explanation is none: a lens far from any that was expected, or a corner in the
/// camera's own place, where it can appear at every pixel.
bool isAbsurd(const RigModel& model, const RigState& state) {
  for (std::size_t i = 0; i < model.sightings().size(); ++i) {
    if (model.lensDeviation(state, i) > kLensLimit ||
        !std::isfinite(model.reprojectionError(state, i)))
      return true;
  }
  return false;
}

/// The camera without which the others agree; -1 when there is none.
int oddOneOut(const RigModel& model,
              const SquareLayout& layout,
              const BranchChoice& choice,
              const Uncertainty& uncertainty) {
  if (model.sightings().size() < 3)
    return -1;
  int odd = -1;
  double least = kWarnRatio;
  for (std::size_t i = 0; i < model.sightings().size(); ++i) {
    std::vector<CameraSightings> others = model.sightings();
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    const RigModel without(others, layout, model.zUp(), uncertainty);
    std::vector<Eigen::Isometry3d> poses;
    for (const geometry::Camera& camera : choice.state.cameras) {
      if (camera.name != model.sightings()[i].name)
        poses.push_back(camera.world_from_camera);
    }
    RigState state = without.start(poses);
    const std::optional<double> cost = without.refineAll(&state, RigModel::Precision::kCoarse);
    if (cost && misfit(*cost, without) < least) {
      least = misfit(*cost, without);
      odd = static_cast<int>(i);
    }
  }
  return odd;
}

void checkGravity(const RigModel& model, const RigState& state, const Uncertainty& uncertainty) {
  for (std::size_t i = 0; i < model.sightings().size(); ++i) {
    const std::optional<double> tilt = model.tiltAgainstGravity(state, i);
    if (tilt && *tilt > kGravityLimit * uncertainty.gravity)
      throw SquareError("the floor as " + model.sightings()[i].name + " sees it is tilted by " +
                        number("%.0f degrees", *tilt * 180.0 / M_PI) +
                        " against its accelerometer: it was moved between the corners, its image "
                        "or its axes are turned, or the floor is not level; correct that, or do "
                        "not use gravity");
  }
}

/// Warns about, or refuses, residuals that the uncertainties do not explain.
void checkMisfit(const RigModel& model,
                 const SquareLayout& layout,
                 const BranchChoice& choice,
                 const Uncertainty& uncertainty,
                 std::vector<std::string>* warnings) {
  const double ratio = misfit(choice.cost, model);
  const bool absurd = isAbsurd(model, choice.state);
  if (ratio < kWarnRatio && !absurd)
    return;
  std::size_t worst = 0;
  double farthest = 0.0;
  for (std::size_t c = 0; c < 4; ++c) {
    const double offset = (choice.state.corners[c] - model.nominalCorners()[c]).norm();
    if (offset > farthest) {
      farthest = offset;
      worst = c;
    }
  }
  std::string reason = "the cameras disagree " + number("%.1f", ratio) +
                       " times as much as the stated errors explain";
  const int odd = oddOneOut(model, layout, choice, uncertainty);
  if (odd >= 0)
    reason += ", and " + model.sightings()[static_cast<std::size_t>(odd)].name +
              " alone contradicts the others: check that it did not move and that its spot was the "
              "LED";
  else
    reason +=
        ", most at corner " + std::to_string(worst + 1) + " (" +
        number("%.0f mm", 1000.0 * farthest) +
        " off): check the sides of the square and capture that corner again, or state a larger "
        "placement error";
  if (ratio > kRefuseRatio || absurd)
    throw SquareError(reason);
  warnings->push_back(reason);
}

geometry::RigCamera rigCamera(const RigModel& model, const RigState& state, std::size_t i) {
  geometry::RigCamera result;
  result.camera = state.cameras[i];
  result.gravity = model.sightings()[i].gravity;
  result.residual_px = model.reprojectionError(state, i);
  double distance = 0.0;
  for (const Eigen::Vector3d& corner : state.corners)
    distance += 0.25 * (corner - result.camera.center()).norm();
  const geometry::Intrinsics& lens = result.camera.intrinsics;
  result.residual_m = result.residual_px * distance / std::sqrt(lens.fx * lens.fy);
  result.observations = 4;
  result.inliers = 4;
  return result;
}

std::string verdict(const SquareSolution& solution) {
  double worst_px = 0.0;
  double worst_m = 0.0;
  for (std::size_t i = 0; i < solution.rig.cameras.size(); ++i) {
    worst_px = std::max(worst_px, solution.rig.cameras[i].residual_px);
    worst_m = std::max(worst_m, solution.rig.cameras[i].residual_m);
  }
  std::string text = std::to_string(solution.rig.cameras.size()) + " cameras solved from a " +
                     number("%.3f m", solution.rig.square_sides[0]) + " x " +
                     number("%.3f m", solution.rig.square_sides[1]) + " square, z points " +
                     (solution.z_up ? "up" : "down") + "; residuals at most " +
                     number("%.2f px", worst_px) + " (" + number("%.1f mm", 1000.0 * worst_m) + ")";
  if (std::isfinite(solution.expected_error))
    text += ", points over the square expected within " +
            number("%.0f mm", 1000.0 * solution.expected_error) + " (RMS)";
  for (const std::string& warning : solution.warnings)
    text += "; warning: " + warning;
  return text;
}

}  // namespace

SquareSolution solveSquare(const SquareLayout& layout,
                           const std::vector<CameraSightings>& cameras,
                           const SolveOptions& options) {
  layout.check();
  options.uncertainty.check();
  const UsableCameras usable = usableCameras(cameras);
  const RigModel model(usable.cameras, layout, usable.z_up, options.uncertainty);
  const std::vector<std::vector<Branch>> branches = branchesOfAll(model);
  const BranchChoice choice = chooseBranches(model, branches, options.branch_odds);

  SquareSolution solution;
  solution.z_up = usable.z_up;
  solution.warnings = usable.warnings;
  checkGravity(model, choice.state, options.uncertainty);
  checkMisfit(model, layout, choice, options.uncertainty, &solution.warnings);
  refuseUndecided(model, branches, choice);

  RigState state = choice.state;
  geometry::Rig& rig = solution.rig;
  if (options.method == Method::kJoint) {
    rig.method = "square";
    rig.covariance = model.covarianceOfAll(state);
  } else {
    std::vector<Eigen::Isometry3d> poses;
    for (std::size_t i = 0; i < branches.size(); ++i)
      poses.push_back(branches[i][choice.chosen[i]].world_from_camera);
    state = model.start(poses);
    rig.method = "square, per camera";
    rig.covariance = model.covarianceOfPoses(state);
  }
  for (std::size_t c = 0; c < 4; ++c)
    solution.corner_offsets[c] = state.corners[c] - model.nominalCorners()[c];

  rig.square_sides = {layout.side_x, layout.side_y};
  rig.led_height = layout.led_height;
  for (std::size_t i = 0; i < state.cameras.size(); ++i)
    rig.cameras.push_back(rigCamera(model, state, i));
  solution.expected_error = expectedError(rig, boxOver(model.nominalCorners(), solution.z_up));
  if (solution.expected_error > kErrorLimit * std::min(layout.side_x, layout.side_y))
    solution.warnings.push_back("points over the square are known to " +
                                number("%.2f m", solution.expected_error) +
                                " only: use a larger square, or place the cameras so that they "
                                "look at it from different sides");
  rig.verdict = verdict(solution);
  return solution;
}

}  // namespace wiimote_tracker::square
