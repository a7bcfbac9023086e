#include "wiimote_tracker_calibration/square/rig_model.h"

#include "wiimote_tracker_calibration/square/error.h"

#include "residuals.h"

#include <ceres/ceres.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <utility>

namespace wiimote_tracker::square {

namespace {

// Per camera in RigCalibration.covariance: rotation 3, position 3, fx fy cx cy, 5 distortion,
// time offset.
constexpr int kMessageSize = 16;
constexpr int kCameraSize = kPoseSize + kLensSize;

Eigen::Matrix3d rotationFromVector(const Eigen::Vector3d& vector) {
  const double angle = vector.norm();
  if (angle == 0.0)
    return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, vector / angle).toRotationMatrix();
}

/// Inverse of a symmetric positive definite matrix whose parameters have very different units.
Eigen::MatrixXd invert(const Eigen::MatrixXd& information) {
  const Eigen::VectorXd scale = information.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * information * scale.asDiagonal();
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(scaled.rows(), scaled.cols());
  const Eigen::MatrixXd inverse = scaled.ldlt().solve(identity);
  const Eigen::MatrixXd result = scale.asDiagonal() * inverse * scale.asDiagonal();
  return 0.5 * (result + result.transpose());
}

/// From 11 parameters per camera (pose, lens) to the layout of the message. Poses, fx, fy, cx, cy
/// and k1 stand side by side in both; everything behind k1 was held.
Eigen::MatrixXd inMessageOrder(const Eigen::MatrixXd& covariance, std::size_t cameras) {
  const auto n = static_cast<Eigen::Index>(cameras);
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(kMessageSize * n, kMessageSize * n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j)
      result.block<kCameraSize, kCameraSize>(kMessageSize * i, kMessageSize * j) =
          covariance.block<kCameraSize, kCameraSize>(kCameraSize * i, kCameraSize * j);
  }
  return result;
}

void checkStddev(const char* what, double value) {
  if (!std::isfinite(value) || value <= 0.0)
    throw SquareError("the standard deviation of the " + std::string(what) + " is " +
                      std::to_string(value) + ", but must be greater than 0: correct it");
}

}  // namespace

void Uncertainty::check() const {
  checkStddev("pixels", pixel);
  checkStddev("placement", placement);
  checkStddev("focal length", focal);
  checkStddev("aspect ratio", aspect);
  checkStddev("principal point", principal_point);
  checkStddev("distortion coefficient k1", k1);
  checkStddev("gravity direction", gravity);
}

/// The least-squares problem around one state. Row order: pixels camera by camera and corner by
/// corner, then the priors. Column order: camera by camera pose and lens, then the corners.
class RigModel::Problem {
 public:
  Problem(const RigModel& model, const RigState& state) : model_(model), state_(state) {
    const std::size_t count = model.sightings_.size();
    pose_.resize(count);
    lens_.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
      const geometry::Camera& camera = state.cameras[i];
      const Eigen::Vector3d center = camera.center();
      pose_[i] = {0.0, 0.0, 0.0, center.x(), center.y(), center.z()};
      const geometry::Intrinsics& lens = camera.intrinsics;
      lens_[i] = {lens.fx, lens.fy, lens.cx, lens.cy, lens.distortion[0]};
    }
    for (std::size_t c = 0; c < 4; ++c) {
      const Eigen::Vector3d offset = state.corners[c] - model.nominal_corners_[c];
      corner_[c] = {offset.x(), offset.y()};
    }
    addPixels();
    addPriors();
  }

  /// @returns the cost (sum of squares) and the state there; nothing when the start is unusable.
  std::optional<double> solve(RigState* state, Precision precision) {
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_QR;
    options.max_num_iterations = 200;
    options.function_tolerance = 1e-15;
    options.gradient_tolerance = 1e-13;
    options.parameter_tolerance = 1e-13;
    if (precision == Precision::kCoarse) {
      options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
      options.max_num_iterations = 200;
      options.function_tolerance = 1e-9;
    }
    options.logging_type = ceres::SILENT;
    double start_cost = 0.0;
    if (!problem_.Evaluate(ceres::Problem::EvaluateOptions(), &start_cost, nullptr, nullptr,
                           nullptr))
      return std::nullopt;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem_, &summary);
    if (!summary.IsSolutionUsable() || !std::isfinite(summary.final_cost))
      return std::nullopt;
    store(state);
    return 2.0 * summary.final_cost;
  }

  Eigen::MatrixXd jacobian() {
    ceres::Problem::EvaluateOptions options;
    options.residual_blocks = residuals_;
    for (std::size_t i = 0; i < pose_.size(); ++i) {
      options.parameter_blocks.push_back(pose_[i].data());
      options.parameter_blocks.push_back(lens_[i].data());
    }
    for (auto& corner : corner_)
      options.parameter_blocks.push_back(corner.data());
    ceres::CRSMatrix sparse;
    problem_.Evaluate(options, nullptr, nullptr, nullptr, &sparse);
    Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(sparse.num_rows, sparse.num_cols);
    for (int row = 0; row < sparse.num_rows; ++row) {
      for (int k = sparse.rows[row]; k < sparse.rows[row + 1]; ++k)
        dense(row, sparse.cols[k]) = sparse.values[k];
    }
    return dense;
  }

 private:
  void addPixels() {
    for (std::size_t i = 0; i < model_.sightings_.size(); ++i) {
      const geometry::Camera& camera = state_.cameras[i];
      for (std::size_t c = 0; c < 4; ++c) {
        if (!model_.sightings_[i].corners[c])
          continue;
        auto* residual =
            new PixelResidual{*model_.sightings_[i].corners[c],  model_.nominal_corners_[c],
                              camera.world_from_camera.linear(), camera.intrinsics.distortion_model,
                              camera.intrinsics.distortion,      model_.uncertainty_.pixel};
        residuals_.push_back(problem_.AddResidualBlock(
            new ceres::AutoDiffCostFunction<PixelResidual, 2, kPoseSize, kLensSize, kCornerSize>(
                residual),
            nullptr, pose_[i].data(), lens_[i].data(), corner_[c].data()));
      }
    }
  }

  void addPriors() {
    for (std::size_t i = 0; i < model_.sightings_.size(); ++i) {
      const CameraSightings& sightings = model_.sightings_[i];
      residuals_.push_back(
          problem_.AddResidualBlock(new ceres::AutoDiffCostFunction<LensPrior, 5, kLensSize>(
                                        new LensPrior{sightings.intrinsics, model_.uncertainty_}),
                                    nullptr, lens_[i].data()));
    }
    for (auto& corner : corner_) {
      residuals_.push_back(
          problem_.AddResidualBlock(new ceres::AutoDiffCostFunction<CornerPrior, 2, kCornerSize>(
                                        new CornerPrior{model_.uncertainty_.placement}),
                                    nullptr, corner.data()));
    }
    for (std::size_t i = 0; i < model_.sightings_.size(); ++i) {
      const std::optional<Eigen::Vector3d>& gravity = model_.sightings_[i].gravity;
      if (!gravity)
        continue;
      const Eigen::Vector3d up(0.0, 0.0, model_.z_up_ ? 1.0 : -1.0);
      residuals_.push_back(problem_.AddResidualBlock(
          new ceres::AutoDiffCostFunction<GravityResidual, 3, kPoseSize>(new GravityResidual{
              gravity->normalized(), up, state_.cameras[i].world_from_camera.linear(),
              model_.uncertainty_.gravity}),
          nullptr, pose_[i].data()));
    }
  }

  void store(RigState* state) const {
    for (std::size_t i = 0; i < pose_.size(); ++i) {
      geometry::Camera& camera = state->cameras[i];
      const Eigen::Vector3d w(pose_[i][0], pose_[i][1], pose_[i][2]);
      const Eigen::Matrix3d turned =
          rotationFromVector(w) * state_.cameras[i].world_from_camera.linear();
      camera.world_from_camera.linear() =
          Eigen::Quaterniond(turned).normalized().toRotationMatrix();
      camera.world_from_camera.translation() =
          Eigen::Vector3d(pose_[i][3], pose_[i][4], pose_[i][5]);
      geometry::Intrinsics& lens = camera.intrinsics;
      lens.fx = lens_[i][0];
      lens.fy = lens_[i][1];
      lens.cx = lens_[i][2];
      lens.cy = lens_[i][3];
      lens.distortion[0] = lens_[i][4];
    }
    for (std::size_t c = 0; c < 4; ++c) {
      const Eigen::Vector3d offset(corner_[c][0], corner_[c][1], 0.0);
      state->corners[c] = model_.nominal_corners_[c] + offset;
    }
  }

  const RigModel& model_;
  const RigState state_;
  ceres::Problem problem_;
  std::vector<ceres::ResidualBlockId> residuals_;
  std::vector<std::array<double, kPoseSize>> pose_;
  std::vector<std::array<double, kLensSize>> lens_;
  std::array<std::array<double, kCornerSize>, 4> corner_;
};

RigModel::RigModel(std::vector<CameraSightings> sightings,
                   const SquareLayout& layout,
                   bool z_up,
                   const Uncertainty& uncertainty)
    : sightings_(std::move(sightings)),
      layout_(layout),
      z_up_(z_up),
      uncertainty_(uncertainty),
      nominal_corners_(layout.corners(z_up)) {}

RigModel RigModel::only(std::size_t camera) const {
  return RigModel({sightings_[camera]}, layout_, z_up_, uncertainty_);
}

RigState RigModel::start(const std::vector<Eigen::Isometry3d>& world_from_camera) const {
  RigState state;
  state.corners = nominal_corners_;
  for (std::size_t i = 0; i < sightings_.size(); ++i) {
    geometry::Camera camera;
    camera.name = sightings_[i].name;
    camera.identity = sightings_[i].identity;
    camera.intrinsics = sightings_[i].intrinsics;
    camera.world_from_camera = world_from_camera[i];
    state.cameras.push_back(camera);
  }
  return state;
}

std::optional<double> RigModel::refineAll(RigState* state, Precision precision) const {
  return Problem(*this, *state).solve(state, precision);
}

int RigModel::degreesOfFreedom() const {
  int result = 0;
  // Pixel coordinates, and six parameters of the pose; every other parameter has its prior.
  for (const CameraSightings& sightings : sightings_)
    result += 2 * static_cast<int>(sightings.cornersSeen()) - 6 + (sightings.gravity ? 2 : 0);
  return result;
}

Eigen::MatrixXd RigModel::covarianceOfAll(const RigState& state) const {
  const Eigen::MatrixXd jacobian = Problem(*this, state).jacobian();
  return inMessageOrder(invert(jacobian.transpose() * jacobian), sightings_.size());
}

CornerEstimates RigModel::cornerEstimates(const RigState& state) const {
  const Eigen::MatrixXd jacobian = Problem(*this, state).jacobian();
  const Eigen::MatrixXd covariance = invert(jacobian.transpose() * jacobian);
  const auto first = kCameraSize * static_cast<Eigen::Index>(sightings_.size());
  CornerEstimates estimates;
  for (std::size_t c = 0; c < 4; ++c) {
    const Eigen::Index row = first + kCornerSize * static_cast<Eigen::Index>(c);
    estimates.offsets[c] = state.corners[c] - nominal_corners_[c];
    estimates.covariances[c] = covariance.block<kCornerSize, kCornerSize>(row, row);
  }
  return estimates;
}

Eigen::MatrixXd RigModel::covarianceOfPoses(const RigState& state) const {
  const Eigen::MatrixXd jacobian = Problem(*this, state).jacobian();
  const auto cameras = static_cast<Eigen::Index>(sightings_.size());
  Eigen::Index pixel_rows = 0;
  for (const CameraSightings& sightings : sightings_)
    pixel_rows += 2 * static_cast<Eigen::Index>(sightings.cornersSeen());
  const Eigen::Index corner_column = kCameraSize * cameras;
  constexpr Eigen::Index kCorners = 4 * kCornerSize;

  // True minus estimated parameters as a linear function of independent unit errors of the lenses,
  // the corners and the pixels, in this order.
  const Eigen::Index errors = kLensSize * cameras + kCorners + pixel_rows;
  Eigen::MatrixXd parameters_from_errors = Eigen::MatrixXd::Zero(kCameraSize * cameras, errors);
  Eigen::Index row = 0;
  for (Eigen::Index i = 0; i < cameras; ++i) {
    const auto count =
        2 * static_cast<Eigen::Index>(sightings_[static_cast<std::size_t>(i)].cornersSeen());
    const auto rows = jacobian.middleRows(row, count);
    const Eigen::MatrixXd pose = rows.middleCols(kCameraSize * i, kPoseSize);
    const Eigen::MatrixXd lens = rows.middleCols(kCameraSize * i + kPoseSize, kLensSize);
    const Eigen::MatrixXd corners = rows.middleCols(corner_column, kCorners);
    const Eigen::MatrixXd lens_prior = jacobian.block(
        pixel_rows + kLensSize * i, kCameraSize * i + kPoseSize, kLensSize, kLensSize);
    const Eigen::MatrixXd lens_from_errors = lens_prior.inverse();
    const Eigen::MatrixXd solve = invert(pose.transpose() * pose) * pose.transpose();
    auto pose_rows = parameters_from_errors.middleRows(kCameraSize * i, kPoseSize);
    pose_rows.middleCols(kLensSize * i, kLensSize) = -solve * lens * lens_from_errors;
    pose_rows.middleCols(kLensSize * cameras, kCorners) = -solve * corners * uncertainty_.placement;
    pose_rows.middleCols(kLensSize * cameras + kCorners + row, count) = -solve;
    row += count;
    parameters_from_errors.block(kCameraSize * i + kPoseSize, kLensSize * i, kLensSize, kLensSize) =
        lens_from_errors;
  }
  return inMessageOrder(parameters_from_errors * parameters_from_errors.transpose(),
                        sightings_.size());
}

double RigModel::reprojectionError(const RigState& state, std::size_t camera) const {
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

double RigModel::lensDeviation(const RigState& state, std::size_t camera) const {
  const geometry::Intrinsics& lens = state.cameras[camera].intrinsics;
  const double parameters[kLensSize] = {lens.fx, lens.fy, lens.cx, lens.cy, lens.distortion[0]};
  Eigen::Matrix<double, kLensSize, 1> residual;
  const LensPrior prior{sightings_[camera].intrinsics, uncertainty_};
  if (!prior(parameters, residual.data()))
    return std::numeric_limits<double>::infinity();
  return residual.norm();
}

std::optional<double> RigModel::tiltAgainstGravity(const RigState& state,
                                                   std::size_t camera) const {
  const std::optional<Eigen::Vector3d>& gravity = sightings_[camera].gravity;
  if (!gravity)
    return std::nullopt;
  const Eigen::Vector3d up(0.0, 0.0, z_up_ ? 1.0 : -1.0);
  const Eigen::Vector3d measured =
      state.cameras[camera].world_from_camera.linear() * gravity->normalized();
  return std::atan2(up.cross(measured).norm(), up.dot(measured));
}

}  // namespace wiimote_tracker::square
