#include "certainty.h"

#include <wiimote_tracker_triangulation/geometry/camera_parameters.h>

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace wiimote_tracker::bundle {

namespace {

constexpr Eigen::Index kPoseSize = 6;
constexpr Eigen::Index kLensSize = 9;
constexpr double kGiven = 1e12;  // information of a parameter that is given
constexpr double kOpen = 1e-13;  // eigenvalues below this share of the largest are rounding errors

/// Weight of a squared residual by the Huber loss.
double huberWeight(double error, double loss_scale) {
  return error > loss_scale ? loss_scale / error : 1.0;
}

/// Motions of points that a similarity makes: one orthonormal column for each of the seven.
Eigen::MatrixXd similarityMotions(const std::vector<Eigen::Vector3d>& points) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points)
    mean += point / static_cast<double>(points.size());
  Eigen::MatrixXd motions(3 * static_cast<Eigen::Index>(points.size()), 7);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d from_mean = points[i] - mean;
    auto rows = motions.middleRows<3>(3 * static_cast<Eigen::Index>(i));
    rows.leftCols<3>().setIdentity();
    for (int axis = 0; axis < 3; ++axis)
      rows.col(3 + axis) = Eigen::Vector3d::Unit(axis).cross(from_mean);
    rows.col(6) = from_mean;
  }
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(motions);
  return qr.householderQ() * Eigen::MatrixXd::Identity(motions.rows(), motions.cols());
}

}  // namespace

double pixelStddev(const Reconstruction& reconstruction, const Options& options) {
  std::vector<std::size_t> views(reconstruction.points.size(), 0);
  double squares = 0.0;
  for (std::size_t i = 0; i < reconstruction.observations.size(); ++i) {
    const Observation& observation = reconstruction.observations[i];
    const auto error = reprojectionError(reconstruction, observation);
    if (!reconstruction.inliers[i] || !error)
      continue;
    ++views[observation.point];
    squares += huberWeight(*error, options.loss_scale) * *error * *error;
  }
  const auto cameras = static_cast<double>(reconstruction.cameras.size());
  const double parameters = cameras * kPoseSize + (options.one_lens ? 1.0 : cameras) * kLensSize;
  double freedom = 7.0 - parameters;  // a similarity is not observed
  for (const std::size_t count : views) {
    if (count >= 2)
      freedom += 2.0 * static_cast<double>(count) - 3.0;
  }
  return std::sqrt(squares / std::max(1.0, freedom));
}

Certainty::Certainty(const Reconstruction& reconstruction,
                     const Options& options,
                     bool fixed_lenses)
    : one_lens_(options.one_lens),
      camera_count_(static_cast<Eigen::Index>(reconstruction.cameras.size())) {
  const Eigen::Index size = column(camera_count_ - 1, kPoseSize - 1) + 1;
  information_ = Eigen::MatrixXd::Zero(size, size);
  addObservations(reconstruction, options);
  const Eigen::Index lenses = column(0, 0);
  if (fixed_lenses)
    information_.diagonal().head(lenses).array() += kGiven;
  else
    addLensPrior(reconstruction, options);
  fixWorld(reconstruction);
  invert();
}

/// Where a parameter of a camera stands: kPoseSize of the pose, then kLensSize of the lens, in the
/// order of geometry/camera_parameters.h.
Eigen::Index Certainty::column(Eigen::Index camera, Eigen::Index parameter) const {
  if (parameter >= kPoseSize)
    return (one_lens_ ? 0 : camera) * kLensSize + parameter - kPoseSize;
  return (one_lens_ ? 1 : camera_count_) * kLensSize + camera * kPoseSize + parameter;
}

void Certainty::add(const PointView& a,
                    const PointView& b,
                    const Matrix15& block,
                    Eigen::MatrixXd* to) const {
  for (Eigen::Index row = 0; row < block.rows(); ++row) {
    for (Eigen::Index col = 0; col < block.cols(); ++col)
      (*to)(column(a.camera, row), column(b.camera, col)) += block(row, col);
  }
}

/// Information of the observations about lenses and poses, the points being free.
void Certainty::addObservations(const Reconstruction& reconstruction, const Options& options) {
  const double stddev = pixelStddev(reconstruction, options);
  std::vector<std::vector<std::size_t>> seen_by(reconstruction.points.size());
  for (std::size_t i = 0; i < reconstruction.observations.size(); ++i) {
    const std::size_t point = reconstruction.observations[i].point;
    if (reconstruction.inliers[i] && reconstruction.points[point])
      seen_by[point].push_back(i);
  }
  for (std::size_t i = 0; i < seen_by.size(); ++i) {
    if (seen_by[i].size() < 2)
      continue;
    PointViews point;
    point.position = *reconstruction.points[i];
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    for (const std::size_t index : seen_by[i]) {
      const Observation& observation = reconstruction.observations[index];
      const auto projection =
          geometry::projectionOf(reconstruction.cameras[observation.camera], point.position);
      if (!projection)
        continue;
      const double error = (projection->pixel - observation.pixel).norm();
      const double weight = huberWeight(error, options.loss_scale) / (stddev * stddev);
      const Eigen::Matrix<double, 2, 15> by_camera = projection->by_parameters.leftCols<15>();
      PointView view;
      view.camera = static_cast<Eigen::Index>(observation.camera);
      view.cross = weight * by_camera.transpose() * projection->by_point;
      information += weight * projection->by_point.transpose() * projection->by_point;
      add(view, view, weight * by_camera.transpose() * by_camera, &information_);
      point.views.push_back(view);
    }
    point.covariance = information.inverse();
    for (const PointView& a : point.views) {
      for (const PointView& b : point.views)
        add(a, b, -a.cross * point.covariance * b.cross.transpose(), &information_);
    }
    points_.push_back(point);
  }
}

/// Adds the prior Options::lens without its focal length.
void Certainty::addLensPrior(const Reconstruction& reconstruction, const Options& options) {
  const LensPrior& prior = options.lens;
  for (Eigen::Index camera = 0; camera < (one_lens_ ? 1 : camera_count_); ++camera) {
    const geometry::Intrinsics& lens =
        reconstruction.cameras[static_cast<std::size_t>(camera)].intrinsics;
    auto information = information_.block<kLensSize, kLensSize>(column(camera, kPoseSize),
                                                                column(camera, kPoseSize));
    const Eigen::Vector2d by_aspect(1.0 / (lens.fx * prior.aspect),
                                    -1.0 / (lens.fy * prior.aspect));
    information.topLeftCorner<2, 2>() += by_aspect * by_aspect.transpose();
    const double center = prior.principal_point * lens.width;
    information.diagonal().segment<2>(2).array() += 1.0 / (center * center);
    for (Eigen::Index k = 0; k < 5; ++k)
      information(4 + k, 4 + k) += std::pow(prior.distortion[static_cast<std::size_t>(k)], -2);
  }
}

/// The pose of the first camera and its distance to the farthest one define the world.
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
  // Large against what the observations say, but not so large that these drown in rounding errors.
  const double kExact = 1e4;
  information_.diagonal().segment<kPoseSize>(column(0, 0)) *= 1.0 + kExact;
  const Eigen::Index position = column(farthest, geometry::kPosition);
  auto block = information_.block<3, 3>(position, position);
  const Eigen::Vector3d along = baseline.normalized();
  block += kExact * block.norm() * along * along.transpose();
}

void Certainty::invert() {
  const Eigen::VectorXd scale = information_.diagonal().cwiseSqrt();
  if (!(scale.minCoeff() > 0.0))
    return;
  const Eigen::VectorXd inverse_scale = scale.cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(
      inverse_scale.asDiagonal() * information_ * inverse_scale.asDiagonal());
  if (eigen.info() != Eigen::Success ||
      !(eigen.eigenvalues().minCoeff() > kOpen * eigen.eigenvalues().maxCoeff()))
    return;
  const Eigen::MatrixXd root = inverse_scale.asDiagonal() * eigen.eigenvectors() *
                               eigen.eigenvalues().cwiseSqrt().cwiseInverse().asDiagonal();
  covariance_ = root * root.transpose();
}

std::optional<Eigen::MatrixXd> Certainty::lensCovariance(std::size_t camera) const {
  if (!covariance_)
    return std::nullopt;
  const Eigen::Index first = column(static_cast<Eigen::Index>(camera), kPoseSize);
  return Eigen::MatrixXd(covariance_->block(first, first, kLensSize, kLensSize));
}

/// The points' covariance is P + D C D^T: P of each point for exact cameras, C of the cameras, and
/// D how the points move with them. Its trace, less what lies along the motions Q of a similarity.
std::optional<double> Certainty::expectedShapeError() const {
  if (!covariance_)
    return std::nullopt;
  std::vector<Eigen::Vector3d> positions;
  for (const PointViews& point : points_)
    positions.push_back(point.position);
  const Eigen::MatrixXd motions = similarityMotions(positions);
  const Eigen::Index size = covariance_->rows();
  Eigen::MatrixXd squares = Eigen::MatrixXd::Zero(size, size);  // D^T D
  Eigen::MatrixXd along = Eigen::MatrixXd::Zero(7, size);       // Q^T D
  double sum = 0.0;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const PointViews& point = points_[i];
    const auto motion = motions.middleRows<3>(3 * static_cast<Eigen::Index>(i));
    sum += point.covariance.trace() - (motion.transpose() * point.covariance * motion).trace();
    for (const PointView& a : point.views) {
      const Eigen::Matrix<double, 3, 15> by_a = -point.covariance * a.cross.transpose();
      const Eigen::Matrix<double, 7, 15> along_a = motion.transpose() * by_a;
      for (Eigen::Index k = 0; k < 15; ++k)
        along.col(column(a.camera, k)) += along_a.col(k);
      for (const PointView& b : point.views)
        add(a, b, -by_a.transpose() * point.covariance * b.cross.transpose(), &squares);
    }
  }
  sum +=
      covariance_->cwiseProduct(squares).sum() - (along * *covariance_ * along.transpose()).trace();
  return std::sqrt(sum / static_cast<double>(points_.size()));
}

}  // namespace wiimote_tracker::bundle
