#pragma once

#include "wiimote_tracker_calibration/square/square_model.h"

#include <Eigen/Geometry>

#include <vector>

namespace wiimote_tracker::square {

/// One pose that explains what a camera saw.
struct Branch {
  /// That of least reprojection error at the starting intrinsics.
  Eigen::Isometry3d world_from_camera = Eigen::Isometry3d::Identity();
  double reprojection_error = 0.0;  ///< sqrt(mean(du^2 + dv^2)) there [px].
  /// SquareModel::refineAll() of this camera alone, from here (-2 log likelihood).
  double cost = 0.0;
};

/// The branches of one camera of the model: one or two, up to four when it saw only three corners;
/// the more probable first; gravity is weighed in where it is known. Empty when nothing explains
/// what it saw.
std::vector<Branch> findBranches(const SquareModel& model, std::size_t camera);

/// The branch of each camera, chosen by all cameras together.
struct BranchChoice {
  RigState state;                   ///< Most probable rig on the chosen branches.
  double cost = 0.0;                ///< SquareModel::refineAll() of it.
  std::vector<std::size_t> chosen;  ///< Index into the branches, per camera.
  /// Indices of cameras for which another branch is nearly as probable.
  std::vector<std::size_t> undecided;
};

/// Weighs combinations of the branches that are not clear from one camera alone: the cameras saw
/// the same four places, so that a branch which needs other displacements of the corners than the
/// other cameras do is less probable.
/// @param branches per camera, from findBranches(): one or two.
/// @param odds least ratio of probabilities between the chosen branch and the other [> 1].
/// @throws SquareError: nothing can be evaluated.
BranchChoice chooseBranches(const SquareModel& model,
                            const std::vector<std::vector<Branch>>& branches,
                            double odds);

}  // namespace wiimote_tracker::square
