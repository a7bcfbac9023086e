#include "wiimote_tracker_calibration/square/square_model.h"

#include "square/error.h"

#include "adjust/camera_blocks.h"
#include "adjust/covariance.h"
#include "adjust/solver.h"
#include "square/known_terms.h"
#include "square/lens_priors.h"

#include <wiimote_tracker_triangulation/geometry/camera_parameters.h>
#include <wiimote_tracker_triangulation/geometry/linear_algebra.h>

#include <ceres/problem.h>

#include <Eigen/Geometry>

#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace wiimote_tracker::square {

/// The least-squares problem around one state.
class SquareModel::Problem {
 public:
  Problem(const SquareModel& model, const RigState& state)
      : known(model.uncertainty_, &cameras, &problem) {
    for (const geometry::Camera& camera : state.cameras)
      cameras.emplace_back(camera);
    for (std::size_t c = 0; c < 4; ++c)
      corners[c] = (state.corners[c] - model.nominal_corners_[c]).head<2>();
    known.addSquare(model.layout_, model.z_up_, model.sightings_, &corners, &places);
    known.addLenses(model.sightings_, &shared_offset);
    known.addGravity(model.sightings_, model.up());
    for (adjust::CameraBlocks& camera : cameras) {
      problem.AddParameterBlock(camera.timeOffset(), adjust::kTimeOffsetSize);
      problem.SetParameterBlockConstant(camera.timeOffset());
    }
  }

  ceres::Problem problem;
  std::vector<adjust::CameraBlocks> cameras;
  std::array<Eigen::Vector2d, 4> corners;   // displacements [m]
  std::vector<Eigen::Vector3d> places;      // [m]
  Eigen::Vector2d shared_offset{0.0, 0.0};  // of the principal points [px]
  KnownTerms known;
};

SquareModel::SquareModel(std::vector<CameraSightings> sightings,
                         const SquareLayout& layout,
                         bool z_up,
                         const Uncertainty& uncertainty)
    : sightings_(std::move(sightings)),
      layout_(layout),
      z_up_(z_up),
      uncertainty_(uncertainty),
      nominal_corners_(layout.corners(z_up)) {}

SquareModel SquareModel::only(std::size_t camera) const {
  return SquareModel({sightings_[camera]}, layout_, z_up_, uncertainty_);
}

RigState SquareModel::start(const std::vector<Eigen::Isometry3d>& world_from_camera) const {
  RigState state;
  state.corners = nominal_corners_;
  for (std::size_t i = 0; i < sightings_.size(); ++i)
    state.cameras.push_back(sightings_[i].camera(world_from_camera[i]));
  return state;
}

std::optional<double> SquareModel::refineAll(RigState* state, Precision precision) const {
  Problem at(*this, *state);
  const bool coarse = precision == Precision::kCoarse;
  const ceres::Solver::Summary summary = adjust::minimise(
      adjust::solverOptions(coarse ? ceres::DENSE_NORMAL_CHOLESKY : ceres::DENSE_QR, 200,
                            {coarse ? 1e-9 : 1e-15, 1e-13, 1e-13}),
      &at.problem);
  if (!summary.IsSolutionUsable() || !std::isfinite(summary.final_cost))
    return std::nullopt;
  for (std::size_t i = 0; i < at.cameras.size(); ++i)
    state->cameras[i] = at.cameras[i].cameraLike(state->cameras[i]);
  for (std::size_t c = 0; c < 4; ++c)
    state->corners[c] =
        nominal_corners_[c] + Eigen::Vector3d(at.corners[c].x(), at.corners[c].y(), 0.0);
  return 2.0 * summary.final_cost;
}

int SquareModel::degreesOfFreedom(const RigState& state) const {
  return static_cast<int>(std::lround(Problem(*this, state).known.degreesOfFreedom()));
}

Eigen::MatrixXd SquareModel::covarianceOfAll(const RigState& state) const {
  Problem at(*this, state);
  std::vector<double*> blocks = adjust::blocksOf(&at.cameras);
  for (auto& corner : at.corners)
    blocks.push_back(corner.data());
  const auto covariance = adjust::covarianceOf(&at.problem, blocks);
  if (!covariance)
    throw SquareError(
        "the corners do not determine where the cameras are: let the cameras look at the square "
        "from different sides");
  return *covariance;
}

namespace {

constexpr Eigen::Index kPose = adjust::kRotationSize + adjust::kPositionSize;

/// Covariance of what is stated of the starting lenses and of the corners; order and units as in
/// covarianceOfAll().
Eigen::MatrixXd statedCovariance(const std::vector<geometry::Camera>& cameras,
                                 const std::vector<CameraSightings>& sightings,
                                 const Uncertainty& stated) {
  const Eigen::Index corners = geometry::firstParameter(cameras.size());
  Eigen::MatrixXd by_errors = Eigen::MatrixXd::Zero(corners + kCornerParameters, corners + 2);
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const Eigen::Index lens = geometry::firstParameter(i) + geometry::kIntrinsics;
    const double fx = cameras[i].intrinsics.fx;
    const double fy = cameras[i].intrinsics.fy;
    by_errors.block<2, 2>(lens, lens) << fx * stated.focal, 0.5 * fx * stated.aspect,
        fy * stated.focal, -0.5 * fy * stated.aspect;
    by_errors.diagonal().segment<3>(lens + 2) << stated.principal_point, stated.principal_point,
        stated.k1;
    if (sharesOffset(sightings[i].intrinsics))
      by_errors.block<2, 2>(lens + 2, corners)
          .diagonal()
          .setConstant(stated.shared_principal_point);
  }
  Eigen::MatrixXd covariance = by_errors * by_errors.transpose();
  covariance.diagonal().tail<kCornerParameters>().setConstant(stated.placement * stated.placement);
  return covariance;
}

}  // namespace

// A pose of least reprojection error follows the pixels p(pose, lens, corners) to first order by
// d pose = (dp/d pose)^+ (dp - dp/d lens d lens - dp/d corners d corners).
Eigen::MatrixXd SquareModel::covarianceOfPoses(const RigState& state) const {
  const Eigen::Index corners = geometry::firstParameter(sightings_.size());
  const Eigen::MatrixXd stated = statedCovariance(state.cameras, sightings_, uncertainty_);
  Eigen::MatrixXd by_stated = Eigen::MatrixXd::Identity(corners, stated.cols());
  Eigen::MatrixXd by_pixels = Eigen::MatrixXd::Zero(corners, 8 * state.cameras.size());
  for (std::size_t i = 0; i < sightings_.size(); ++i) {
    const Eigen::Index pose = geometry::firstParameter(i);
    Eigen::MatrixXd pixels = Eigen::MatrixXd::Zero(8, stated.cols());  // 0: of a corner not seen
    for (Eigen::Index c = 0; c < 4; ++c) {
      const auto corner = static_cast<std::size_t>(c);
      if (!sightings_[i].corners[corner])
        continue;
      const auto projection =
          geometry::projectionOf(state.cameras[i], state.corners[corner]).value();
      pixels.block<2, geometry::kParameters>(2 * c, pose) = projection.by_parameters;
      pixels.block<2, 2>(2 * c, corners + 2 * c) = projection.by_point.leftCols<2>();
    }
    const Eigen::MatrixXd pose_by_pixels = geometry::pseudoInverse(pixels.middleCols<kPose>(pose));
    pixels.middleCols<kPose>(pose).setZero();
    by_stated.middleRows<kPose>(pose) = -pose_by_pixels * pixels;
    by_pixels.block<kPose, 8>(pose, 8 * static_cast<Eigen::Index>(i)) = pose_by_pixels;
  }
  return geometry::propagated(by_stated, stated) +
         uncertainty_.pixel * uncertainty_.pixel * by_pixels * by_pixels.transpose();
}

double SquareModel::reprojectionError(const RigState& state, std::size_t camera) const {
  double sum = 0.0;
  for (std::size_t c = 0; c < 4; ++c) {
    if (!sightings_[camera].corners[c])
      continue;
    const auto pixel = state.cameras[camera].project(state.corners[c]);
    if (!pixel)
      return std::numeric_limits<double>::infinity();
    sum += (*pixel - *sightings_[camera].corners[c]).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(sightings_[camera].cornersSeen()));
}

double SquareModel::lensDeviation(const RigState& state, std::size_t camera) const {
  return marginalLensPrior(sightings_[camera].intrinsics, uncertainty_)
      .deviation(state.cameras[camera].intrinsics);
}

}  // namespace wiimote_tracker::square
