#include "wiimote_tracker_calibration/square/solve_square.h"

#include "adjust/chi_squared.h"
#include "square/error.h"
#include "square/expected_error.h"
#include "square/limits.h"
#include "wiimote_tracker_calibration/square/branches.h"

#include "usable_cameras.h"

#include <wiimote_tracker_msgs/text.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace wiimote_tracker::square {

namespace {

// A calibration that puts points off by more than this share of the square's side is reported.
constexpr double kErrorLimit = 0.03;

/// Cameras with their branches.
struct Candidates {
  std::vector<CameraSightings> cameras;
  std::vector<std::vector<Branch>> branches;
};

/// The branches of all cameras. A camera that saw three corners keeps only its most probable
/// branch, which its own accelerometer must determine; otherwise it is left out.
Candidates findCandidates(const SquareModel& model,
                          double odds,
                          std::vector<std::string>* warnings) {
  Candidates result;
  for (std::size_t i = 0; i < model.sightings().size(); ++i) {
    const CameraSightings& camera = model.sightings()[i];
    std::vector<Branch> branches = findBranches(model, i);
    if (camera.cornersSeen() == 4) {
      if (branches.empty())
        throw SquareContradiction(
            "no place explains what " + camera.name +
            " saw of the square: check its starting intrinsics and the sides of the "
            "square, and capture the corners again");
    } else if (branches.empty() || (branches.size() > 1 &&
                                    branches[1].cost - branches[0].cost < 2.0 * std::log(odds))) {
      warnings->push_back(
          camera.name + " saw only three corners and was left out, because " +
          (branches.empty()
               ? "no place explains them"
               : std::to_string(branches.size()) +
                     " places explain them and its accelerometer does not tell which") +
          ": let it see the fourth");
      continue;
    } else {
      warnings->push_back(camera.name +
                          " saw only three corners: its place follows from them and its "
                          "accelerometer, with less to check it by");
      branches.resize(1);
    }
    result.cameras.push_back(camera);
    result.branches.push_back(std::move(branches));
  }
  if (result.cameras.size() < 2)
    throw SquareError("fewer than two cameras can be placed: " + warnings->back());
  return result;
}

void refuseUndecided(const SquareModel& model,
                     const std::vector<std::vector<Branch>>& branches,
                     const BranchChoice& choice) {
  if (choice.undecided.empty())
    return;
  const std::size_t i = choice.undecided.front();
  const std::vector<Branch>& both = branches[i];
  const double apart =
      (both[0].world_from_camera.translation() - both[1].world_from_camera.translation()).norm();
  throw SquareError(
      model.sightings()[i].name +
      format(" can stand in two places, %.2f m apart, that explain what it saw (to %.2f and %.2f "
             "px), and the data do not tell which: let it look at the square more from the side or "
             "from "
             "nearer, use a larger square, or use its accelerometer",
             apart, both[0].reprojection_error, both[1].reprojection_error));
}

/// Whether the best solution is implausible: a lens far from its starting value, or a corner behind
/// the camera or in its centre.
bool isImplausible(const SquareModel& model, const RigState& state) {
  for (std::size_t i = 0; i < model.sightings().size(); ++i) {
    if (model.lensDeviation(state, i) > kLensLimit ||
        !std::isfinite(model.reprojectionError(state, i)))
      return true;
  }
  return false;
}

void checkGravity(const SquareModel& model,
                  const RigState& state,
                  bool z_up,
                  const Uncertainty& uncertainty) {
  for (std::size_t i = 0; i < model.sightings().size(); ++i) {
    const auto tilt = model.sightings()[i].tilt(state.cameras[i].world_from_camera, z_up);
    if (tilt && *tilt > kGravityLimit * uncertainty.gravity)
      throw SquareContradiction(
          "the floor as " + model.sightings()[i].name + " sees it is tilted by " +
          format("%.0f degrees", *tilt * 180.0 / M_PI) +
          " against its accelerometer: it was moved between the corners, its image "
          "or its axes are turned, or the floor is not level; correct that, or do "
          "not use gravity");
  }
}

/// Warns about, or refuses, residuals that the uncertainties do not explain.
void checkMisfit(const SquareModel& model, const BranchChoice& choice, Solution* solution) {
  const int freedom = model.degreesOfFreedom(choice.state);
  solution->misfit = std::sqrt(choice.cost / std::max(1, freedom));
  const bool implausible = isImplausible(model, choice.state);
  // By chance it is in fewer than one of 1000 calibrations.
  const bool is_significant =
      freedom > 0 && choice.cost > adjust::chiSquaredQuantile(freedom, adjust::kThreeNines);
  solution->contradicts = implausible || is_significant;
  if (!solution->contradicts)
    return;
  const std::string reason =
      "the cameras disagree " + format("%.1f", solution->misfit) +
      " times as much as the stated errors explain: check the sides of the square, the starting "
      "intrinsics and that no camera moved";
  if (solution->misfit > kRefuseRatio || implausible)
    throw SquareContradiction(reason);
  solution->warnings.push_back(reason);
}

/// Displacement of the corners from the layout.
Corners offsetsOf(const SquareModel& model, const RigState& state) {
  Corners offsets;
  for (std::size_t c = 0; c < offsets.size(); ++c)
    offsets[c] = state.corners[c] - model.nominalCorners()[c];
  return offsets;
}

geometry::RigCamera rigCamera(const SquareModel& model, const RigState& state, std::size_t i) {
  geometry::RigCamera result;
  result.camera = state.cameras[i];
  result.gravity = model.sightings()[i].gravity;
  result.residual_px = model.reprojectionError(state, i);
  double distance = 0.0;
  for (const Eigen::Vector3d& corner : state.corners)
    distance += 0.25 * (corner - result.camera.center()).norm();
  const geometry::Intrinsics& lens = result.camera.intrinsics;
  result.residual_m = result.residual_px * distance / std::sqrt(lens.fx * lens.fy);
  result.observations = static_cast<std::uint32_t>(model.sightings()[i].cornersSeen());
  result.inliers = result.observations;
  return result;
}

std::string describe(const Solution& solution) {
  const geometry::Rig& rig = solution.rig;
  double worst_px = 0.0;
  double worst_m = 0.0;
  for (const geometry::RigCamera& camera : rig.cameras) {
    worst_px = std::max(worst_px, camera.residual_px);
    worst_m = std::max(worst_m, camera.residual_m);
  }
  std::string text = format(
      "%zu cameras solved from a %.3f m x %.3f m square, z points %s; residuals at most %.2f px "
      "(%.1f mm)",
      rig.cameras.size(), rig.square_sides[0], rig.square_sides[1], solution.z_up ? "up" : "down",
      worst_px, 1000.0 * worst_m);
  if (solution.joint_covariance.size() > 0)  // else the corners were taken as exact
    text += " with the corners fitted";
  if (std::isfinite(solution.expected_error))
    text += format("; points in the box over the square expected within %.0f mm (RMS)",
                   1000.0 * solution.expected_error);
  return text;
}

}  // namespace

Solution solveSquare(const SquareLayout& layout,
                     const std::vector<CameraSightings>& cameras,
                     const SolveOptions& options) {
  layout.check();
  const UsableCameras usable = usableCameras(cameras);
  Solution solution;
  solution.z_up = usable.z_up;
  solution.warnings = usable.warnings;
  const Candidates candidates =
      findCandidates(SquareModel(usable.cameras, layout, usable.z_up, options.uncertainty),
                     options.branch_odds, &solution.warnings);
  const SquareModel model(candidates.cameras, layout, usable.z_up, options.uncertainty);
  const std::vector<std::vector<Branch>>& branches = candidates.branches;
  const BranchChoice choice = chooseBranches(model, branches, options.branch_odds);
  checkGravity(model, choice.state, usable.z_up, options.uncertainty);
  Eigen::MatrixXd joint;
  if (!isImplausible(model, choice.state)) {
    joint = model.covarianceOfAll(choice.state);
    solution.suspect =
        suspectCorner(offsetsOf(model, choice.state), joint, options.uncertainty.placement);
  }
  checkMisfit(model, choice, &solution);
  refuseUndecided(model, branches, choice);

  RigState state = choice.state;
  geometry::Rig& rig = solution.rig;
  if (options.method == Method::kJoint) {
    rig.method = "square";
    solution.joint_covariance = joint;
    const Eigen::Index of_cameras = joint.rows() - kCornerParameters;
    rig.covariance = joint.topLeftCorner(of_cameras, of_cameras);
  } else {
    std::vector<Eigen::Isometry3d> poses;
    for (std::size_t i = 0; i < branches.size(); ++i)
      poses.push_back(branches[i][choice.chosen[i]].world_from_camera);
    state = model.start(poses);
    rig.method = "square, per camera";
    rig.covariance = model.covarianceOfPoses(state);
  }
  solution.corner_offsets = offsetsOf(model, state);
  solution.path.assign(model.nominalCorners().begin(), model.nominalCorners().end());

  layout.describeIn(&rig);
  for (std::size_t i = 0; i < state.cameras.size(); ++i)
    rig.cameras.push_back(rigCamera(model, state, i));
  solution.expected_error = expectedError(rig, boxOver(model.nominalCorners(), solution.z_up));
  if (solution.expected_error > kErrorLimit * std::min(layout.side_x, layout.side_y))
    solution.warnings.push_back(
        format("points over the square are known to %.2f m only: use a larger square, or place the "
               "cameras so that they look at it from different sides",
               solution.expected_error));
  rig.verdict = describe(solution);
  return solution;
}

}  // namespace wiimote_tracker::square
