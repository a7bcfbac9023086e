#include "certainty.h"

#include "camera_blocks.h"
#include "reprojection_cost.h"

#include "wiimote_tracker_calibration/bundle/error.h"
#include "wiimote_tracker_calibration/bundle/similarity.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <random>

namespace wiimote_tracker::bundle {

namespace {

constexpr Eigen::Index kPoseSize = 6;
constexpr double kGiven = 1e12;  // information of a parameter that is given
constexpr double kOpen = 1e-13;  // eigenvalues below this share of the largest are rounding errors

template <int Columns>
using RowMajor = Eigen::Matrix<double, 2, Columns, Eigen::RowMajor>;

}  // namespace

Certainty::Certainty(const Reconstruction& reconstruction,
                     const Options& options,
                     bool fixed_lenses)
    : one_lens_(options.one_lens),
      camera_count_(static_cast<Eigen::Index>(reconstruction.cameras.size())) {
  linearize(reconstruction, options);
  reduce();
  if (fixed_lenses)
    information_.topLeftCorner(column(0, kIntrinsicsSize), column(0, kIntrinsicsSize))
        .diagonal()
        .array() += kGiven;
  else
    addWhatIsKnown(reconstruction, options);
  fixWorld(reconstruction);
  invert();
}

/// Place of a camera's parameter: kIntrinsicsSize of the lens, kPoseSize of the pose.
Eigen::Index Certainty::column(Eigen::Index camera, Eigen::Index parameter) const {
  if (parameter < kIntrinsicsSize)
    return (one_lens_ ? 0 : camera) * kIntrinsicsSize + parameter;
  const Eigen::Index lenses = one_lens_ ? 1 : camera_count_;
  return lenses * kIntrinsicsSize + camera * kPoseSize + parameter - kIntrinsicsSize;
}

void Certainty::linearize(const Reconstruction& reconstruction, const Options& options) {
  std::vector<CameraBlocks> blocks;
  for (const geometry::Camera& camera : reconstruction.cameras)
    blocks.push_back(blocksOf(camera));
  std::vector<std::vector<PointView>> views(reconstruction.points.size());
  double squares = 0.0;
  for (std::size_t i = 0; i < reconstruction.observations.size(); ++i) {
    const Observation& observation = reconstruction.observations[i];
    const auto& point = reconstruction.points[observation.point];
    if (!reconstruction.inliers[i] || !point)
      continue;
    const CameraBlocks& camera = blocks[observation.camera];
    const std::unique_ptr<ceres::CostFunction> cost(ReprojectionCost::create(
        observation.pixel, reconstruction.cameras[observation.camera].intrinsics.distortion_model));
    const double* parameters[] = {camera.intrinsics.data(), camera.rotation.data(),
                                  camera.position.data(), point->data()};
    Eigen::Vector2d residual;
    RowMajor<kIntrinsicsSize> by_lens;
    RowMajor<3> by_rotation;
    RowMajor<3> by_position;
    RowMajor<3> by_point;
    double* jacobians[] = {by_lens.data(), by_rotation.data(), by_position.data(), by_point.data()};
    if (!cost->Evaluate(parameters, residual.data(), jacobians))
      continue;
    const double weight = std::sqrt(std::min(1.0, options.loss_scale / residual.norm()));
    PointView view;
    view.camera = static_cast<Eigen::Index>(observation.camera);
    view.by_camera.leftCols<kIntrinsicsSize>() = weight * by_lens;
    view.by_camera.middleCols<3>(kIntrinsicsSize) = weight * by_rotation;
    view.by_camera.rightCols<3>() = weight * by_position;
    view.by_point = weight * by_point;
    views[observation.point].push_back(view);
    squares += weight * weight * residual.squaredNorm();
  }
  double numbers = 0.0;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (views[i].size() < 2)
      continue;
    numbers += 2.0 * static_cast<double>(views[i].size()) - 3.0;
    points_.push_back(views[i]);
    positions_.push_back(*reconstruction.points[i]);
  }
  const Eigen::Index size = column(camera_count_ - 1, kIntrinsicsSize + kPoseSize - 1) + 1;
  pixel_stddev_ = std::sqrt(squares / std::max(1.0, numbers - static_cast<double>(size) + 7.0));
  information_ = Eigen::MatrixXd::Zero(size, size);
}

/// Information of the observations about lenses and poses, the points being free.
void Certainty::reduce() {
  for (const std::vector<PointView>& views : points_) {
    const auto rows = 2 * static_cast<Eigen::Index>(views.size());
    Eigen::MatrixXd by_point(rows, 3);
    for (std::size_t i = 0; i < views.size(); ++i)
      by_point.middleRows<2>(2 * static_cast<Eigen::Index>(i)) = views[i].by_point;
    const Eigen::MatrixXd free =
        Eigen::MatrixXd::Identity(rows, rows) -
        by_point * (by_point.transpose() * by_point).ldlt().solve(by_point.transpose());
    for (std::size_t i = 0; i < views.size(); ++i) {
      for (std::size_t j = 0; j < views.size(); ++j) {
        const Eigen::Matrix<double, 15, 15> block =
            views[i].by_camera.transpose() *
            free.block<2, 2>(2 * static_cast<Eigen::Index>(i), 2 * static_cast<Eigen::Index>(j)) *
            views[j].by_camera;
        for (Eigen::Index row = 0; row < block.rows(); ++row) {
          for (Eigen::Index col = 0; col < block.cols(); ++col)
            information_(column(views[i].camera, row), column(views[j].camera, col)) +=
                block(row, col);
        }
      }
    }
  }
  information_ /= pixel_stddev_ * pixel_stddev_;
}

/// What is known of the lenses.
void Certainty::addWhatIsKnown(const Reconstruction& reconstruction, const Options& options) {
  LensPrior prior = options.lens;
  prior.focal_length = std::numeric_limits<double>::infinity();
  for (Eigen::Index camera = 0; camera < (one_lens_ ? 1 : camera_count_); ++camera) {
    const geometry::Intrinsics& lens =
        reconstruction.cameras[static_cast<std::size_t>(camera)].intrinsics;
    const std::unique_ptr<ceres::CostFunction> cost(LensPriorCost::create(lens, prior, 1.0));
    const auto values = blocksOf(reconstruction.cameras[static_cast<std::size_t>(camera)]);
    const double* parameters[] = {values.intrinsics.data()};
    Eigen::Matrix<double, kIntrinsicsSize, 1> residual;
    Eigen::Matrix<double, kIntrinsicsSize, kIntrinsicsSize, Eigen::RowMajor> jacobian;
    double* jacobians[] = {jacobian.data()};
    if (cost->Evaluate(parameters, residual.data(), jacobians))
      information_.block<kIntrinsicsSize, kIntrinsicsSize>(column(camera, 0), column(camera, 0)) +=
          jacobian.transpose() * jacobian;
  }
}

/// The world is where one camera's pose and its distance to another put it.
void Certainty::fixWorld(const Reconstruction& reconstruction) {
  const Eigen::Vector3d origin = reconstruction.cameras.front().center();
  Eigen::Index farthest = 0;
  Eigen::Vector3d baseline = Eigen::Vector3d::Zero();
  for (Eigen::Index camera = 1; camera < camera_count_; ++camera) {
    const Eigen::Vector3d to =
        reconstruction.cameras[static_cast<std::size_t>(camera)].center() - origin;
    if (to.norm() > baseline.norm()) {
      baseline = to;
      farthest = camera;
    }
  }
  // As exact as these are, they dominate what they are added to by some digits only.
  const double kExact = 1e4;
  const Eigen::Index first = column(0, kIntrinsicsSize);
  for (Eigen::Index i = first; i < first + kPoseSize; ++i)
    information_(i, i) *= 1.0 + kExact;
  const Eigen::Index position = column(farthest, kIntrinsicsSize + 3);
  const double strength = kExact * information_.block<3, 3>(position, position).norm();
  const Eigen::Vector3d along = baseline.normalized();
  information_.block<3, 3>(position, position) += strength * along * along.transpose();
}

void Certainty::invert() {
  const Eigen::VectorXd scale = information_.diagonal().cwiseSqrt();
  if (!(scale.minCoeff() > 0.0))
    return;
  const Eigen::MatrixXd scaled =
      scale.cwiseInverse().asDiagonal() * information_ * scale.cwiseInverse().asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scaled);
  if (eigen.info() != Eigen::Success ||
      !(eigen.eigenvalues().minCoeff() > kOpen * eigen.eigenvalues().maxCoeff()))
    return;
  root_ = scale.cwiseInverse().asDiagonal() * eigen.eigenvectors() *
          eigen.eigenvalues().cwiseSqrt().cwiseInverse().asDiagonal();
}

std::optional<Eigen::MatrixXd> Certainty::lensCovariance(std::size_t camera) const {
  if (!root_)
    return std::nullopt;
  const Eigen::MatrixXd lens =
      root_->middleRows(column(static_cast<Eigen::Index>(camera), 0), kIntrinsicsSize);
  return Eigen::MatrixXd(lens * lens.transpose());
}

std::optional<double> Certainty::expectedShapeError() const {
  const int kDraws = 20;
  if (!root_)
    return std::nullopt;
  std::mt19937 random(1);
  std::normal_distribution<double> normal(0.0, 1.0);
  double squares = 0.0;
  for (int draw = 0; draw < kDraws; ++draw) {
    Eigen::VectorXd white(root_->cols());
    for (double& value : white)
      value = normal(random);
    const Eigen::VectorXd cameras = *root_ * white;
    std::vector<Eigen::Vector3d> moved;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
      Eigen::Vector3d pull = Eigen::Vector3d::Zero();
      for (const PointView& view : points_[i]) {
        Eigen::Matrix<double, 15, 1> camera;
        for (Eigen::Index k = 0; k < camera.size(); ++k)
          camera(k) = cameras(column(view.camera, k));
        const Eigen::Vector2d noise(normal(random), normal(random));
        information += view.by_point.transpose() * view.by_point;
        pull += view.by_point.transpose() * (pixel_stddev_ * noise - view.by_camera * camera);
      }
      moved.push_back(positions_[i] + information.ldlt().solve(pull));
    }
    const Similarity similarity = fitSimilarity(moved, positions_);
    double sum = 0.0;
    for (std::size_t i = 0; i < moved.size(); ++i)
      sum += (similarity * moved[i] - positions_[i]).squaredNorm();
    squares += sum / static_cast<double>(moved.size());
  }
  return std::sqrt(squares / kDraws);
}

}  // namespace wiimote_tracker::bundle
