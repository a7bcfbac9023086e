#include "wiimote_tracker_calibration/square/square_model.h"

#include "square/error.h"

#include "adjust/camera_blocks.h"
#include "adjust/covariance.h"
#include "square/known_terms.h"
#include "square/lens_priors.h"

#include <wiimote_tracker_triangulation/geometry/camera_parameters.h>
#include <wiimote_tracker_triangulation/geometry/linear_algebra.h>

#include <ceres/ceres.h>

#include <Eigen/Geometry>

#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace wiimote_tracker::square {

/// The least-squares problem around one state.
class SquareModel::Problem {
 public:
  Problem(const SquareModel& model, const RigState& state) : model_(model), state_(state) {
    for (const geometry::Camera& camera : state.cameras)
      cameras_.emplace_back(camera);
    for (std::size_t c = 0; c < 4; ++c)
      corners_[c] = (state.corners[c] - model.nominal_corners_[c]).head<2>();
    known_.addSquare(model.layout_, model.z_up_, model.sightings_, &corners_);
    known_.addLenses(model.sightings_);
    known_.addGravity(model.sightings_, model.up());
    for (adjust::CameraBlocks& camera : cameras_) {
      problem_.AddParameterBlock(&camera.time_offset, 1);
      problem_.SetParameterBlockConstant(&camera.time_offset);
    }
  }

  /// @returns the cost (sum of squares) and the state there; nothing when the start is unusable.
  std::optional<double> solve(RigState* state, Precision precision) {
    ceres::Solver::Options options;
    options.max_num_iterations = 200;
    options.logging_type = ceres::SILENT;
    const bool coarse = precision == Precision::kCoarse;
    options.linear_solver_type = coarse ? ceres::DENSE_NORMAL_CHOLESKY : ceres::DENSE_QR;
    options.function_tolerance = coarse ? 1e-9 : 1e-15;
    options.gradient_tolerance = 1e-13;
    options.parameter_tolerance = 1e-13;
    double start_cost = 0.0;
    if (!problem_.Evaluate(ceres::Problem::EvaluateOptions(), &start_cost, nullptr, nullptr,
                           nullptr))
      return std::nullopt;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem_, &summary);
    if (!summary.IsSolutionUsable() || !std::isfinite(summary.final_cost))
      return std::nullopt;
    for (std::size_t i = 0; i < cameras_.size(); ++i)
      state->cameras[i] = cameras_[i].cameraLike(state_.cameras[i]);
    for (std::size_t c = 0; c < 4; ++c)
      state->corners[c] =
          model_.nominal_corners_[c] + Eigen::Vector3d(corners_[c].x(), corners_[c].y(), 0.0);
    return 2.0 * summary.final_cost;
  }

  /// As SquareModel::degreesOfFreedom().
  int degreesOfFreedom() const { return static_cast<int>(std::lround(known_.degreesOfFreedom())); }

  /// As SquareModel::covarianceOfAll().
  Eigen::MatrixXd covariance() {
    std::vector<double*> blocks = adjust::blocksOf(&cameras_);
    for (auto& corner : corners_)
      blocks.push_back(corner.data());
    const auto covariance = adjust::covarianceOf(&problem_, blocks);
    if (!covariance)
      throw SquareError(
          "the corners do not determine where the cameras are: let the cameras look at the square "
          "from different sides");
    return *covariance;
  }

 private:
  const SquareModel& model_;
  const RigState state_;
  ceres::Problem problem_;
  std::vector<adjust::CameraBlocks> cameras_;
  std::array<Eigen::Vector2d, 4> corners_;  // displacements [m]
  KnownTerms known_{model_.uncertainty_, &cameras_, &problem_};
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
  return Problem(*this, *state).solve(state, precision);
}

int SquareModel::degreesOfFreedom(const RigState& state) const {
  return Problem(*this, state).degreesOfFreedom();
}

Eigen::MatrixXd SquareModel::covarianceOfAll(const RigState& state) const {
  return Problem(*this, state).covariance();
}

namespace {

constexpr Eigen::Index kPose = adjust::kRotationSize + adjust::kPositionSize;
constexpr Eigen::Index kLens = adjust::kLensSize;
constexpr Eigen::Index kPrincipalPoint = 2;  // of a lens

/// Derivatives of the pixels of the corners that a camera saw, two rows each.
struct CornerPixels {
  Eigen::Matrix<double, Eigen::Dynamic, geometry::kParameters> by_camera;
  Eigen::Matrix<double, Eigen::Dynamic, kCornerParameters> by_corners;
};

CornerPixels cornerPixels(const geometry::Camera& camera,
                          const CameraSightings& seen,
                          const Corners& corners) {
  const auto rows = 2 * static_cast<Eigen::Index>(seen.cornersSeen());
  CornerPixels pixels;
  pixels.by_camera.resize(rows, geometry::kParameters);
  pixels.by_corners.setZero(rows, kCornerParameters);
  Eigen::Index row = 0;
  for (std::size_t c = 0; c < corners.size(); ++c) {
    if (!seen.corners[c])
      continue;
    const auto projection = geometry::projectionOf(camera, corners[c]).value();
    pixels.by_camera.middleRows<2>(row) = projection.by_parameters;
    pixels.by_corners.block<2, 2>(row, 2 * static_cast<Eigen::Index>(c)) =
        projection.by_point.leftCols<2>();
    row += 2;
  }
  return pixels;
}

/// Derivative of a lens by unit errors of its focal length, aspect, principal point and k1.
Eigen::Matrix<double, kLens, kLens> lensByErrors(const geometry::Intrinsics& lens,
                                                 const Uncertainty& stated) {
  Eigen::Matrix<double, kLens, kLens> by_errors = Eigen::Matrix<double, kLens, kLens>::Zero();
  by_errors.topLeftCorner<2, 2>() << lens.fx * stated.focal, 0.5 * lens.fx * stated.aspect,
      lens.fy * stated.focal, -0.5 * lens.fy * stated.aspect;
  by_errors.diagonal().tail<3>() << stated.principal_point, stated.principal_point, stated.k1;
  return by_errors;
}

}  // namespace

// A pose of least reprojection error follows the pixels p(pose, lens, corners) to first order by
// d pose = (dp/d pose)^+ (dp - dp/d lens d lens - dp/d corners d corners).
Eigen::MatrixXd SquareModel::covarianceOfPoses(const RigState& state) const {
  constexpr Eigen::Index kShared = 2;
  constexpr Eigen::Index kPixels = 8;
  constexpr Eigen::Index kOwn = kLens + kPixels;
  const auto cameras = static_cast<Eigen::Index>(sightings_.size());
  // Derivative of all parameters by independent unit errors: of all corners, of the principal
  // points' shared offset, then of the lens and the pixels camera by camera.
  Eigen::MatrixXd by_errors = Eigen::MatrixXd::Zero(geometry::kParameters * cameras,
                                                    kCornerParameters + kShared + kOwn * cameras);
  for (std::size_t i = 0; i < sightings_.size(); ++i) {
    const CornerPixels pixels = cornerPixels(state.cameras[i], sightings_[i], state.corners);
    const auto lens_by_errors = lensByErrors(state.cameras[i].intrinsics, uncertainty_);
    const Eigen::MatrixXd pose_by_pixels =
        geometry::pseudoInverse(pixels.by_camera.leftCols<kPose>());
    const Eigen::MatrixXd pose_by_lens =
        -pose_by_pixels * pixels.by_camera.middleCols<kLens>(geometry::kIntrinsics);

    auto rows = by_errors.middleRows<geometry::kParameters>(geometry::firstParameter(i));
    auto pose = rows.topRows<kPose>();
    auto lens = rows.middleRows<kLens>(geometry::kIntrinsics);
    const Eigen::Index own = kCornerParameters + kShared + kOwn * static_cast<Eigen::Index>(i);
    pose.leftCols<kCornerParameters>() =
        -uncertainty_.placement * pose_by_pixels * pixels.by_corners;
    pose.middleCols<kLens>(own) = pose_by_lens * lens_by_errors;
    pose.middleCols(own + kLens, pose_by_pixels.cols()) = uncertainty_.pixel * pose_by_pixels;
    lens.middleCols<kLens>(own) = lens_by_errors;
    if (sharesOffset(sightings_[i].intrinsics)) {
      const double shared = uncertainty_.shared_principal_point;
      pose.middleCols<kShared>(kCornerParameters) =
          shared * pose_by_lens.middleCols<kShared>(kPrincipalPoint);
      lens.block<kShared, kShared>(kPrincipalPoint, kCornerParameters)
          .diagonal()
          .setConstant(shared);
    }
  }
  return by_errors * by_errors.transpose();
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
