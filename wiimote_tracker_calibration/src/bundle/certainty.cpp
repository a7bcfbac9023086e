#include "certainty.h"

#include "wiimote_tracker_calibration/bundle/similarity.h"

#include <wiimote_tracker_triangulation/geometry/camera_parameters.h>
#include <wiimote_tracker_triangulation/geometry/linear_algebra.h>

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace wiimote_tracker::bundle {

namespace {

constexpr int kPoseSize = 6;
constexpr int kIntrinsicsSize = 9;
constexpr double kGiven = 1e12;  // information of a parameter that is held

}  // namespace

double pixelStddev(const Reconstruction& reconstruction,
                   const Options& options,
                   bool fixed_lenses) {
  std::vector<std::size_t> views(reconstruction.points.size(), 0);
  double squares = 0.0;
  for (std::size_t i = 0; i < reconstruction.observations.size(); ++i) {
    const Observation& observation = reconstruction.observations[i];
    const auto error = reprojectionError(reconstruction, observation);
    if (!reconstruction.inliers[i] || !error)
      continue;
    ++views[observation.point];
    squares += *error * *error;
  }
  const auto cameras = static_cast<double>(reconstruction.cameras.size());
  const double lenses = fixed_lenses ? 0.0 : options.one_lens ? 1.0 : cameras;
  const double parameters = cameras * kPoseSize + lenses * kIntrinsicsSize;
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
    : one_lens_(options.one_lens), camera_count_(reconstruction.cameras.size()) {
  const Eigen::Index size = poseColumn(camera_count_);
  information_ = Eigen::MatrixXd::Zero(size, size);
  gradient_ = Eigen::VectorXd::Zero(size);
  addObservations(reconstruction, pixelStddev(reconstruction, options, fixed_lenses));
  if (fixed_lenses)
    information_.diagonal().head(poseColumn(0)).array() += kGiven;
  else
    addLensPrior(reconstruction, options);
  fixWorld(reconstruction);
  covariance_ = geometry::inverseOfInformation(information_);
}

/// Where the parameters of a camera stand, in the order of geometry/camera_parameters.h.
Eigen::Index Certainty::lensColumn(std::size_t camera) const {
  return one_lens_ ? 0 : kIntrinsicsSize * static_cast<Eigen::Index>(camera);
}

Eigen::Index Certainty::poseColumn(std::size_t camera) const {
  const std::size_t lenses = one_lens_ ? 1 : camera_count_;
  return static_cast<Eigen::Index>(kIntrinsicsSize * lenses + kPoseSize * camera);
}

/// Information of the observations about lenses and poses, the points being free.
/// @param stddev of a pixel coordinate [px].
void Certainty::addObservations(const Reconstruction& reconstruction, double stddev) {
  std::vector<std::vector<const Observation*>> views(reconstruction.points.size());
  for (std::size_t i = 0; i < reconstruction.observations.size(); ++i) {
    const Observation& observation = reconstruction.observations[i];
    if (reconstruction.inliers[i] && reconstruction.points[observation.point])
      views[observation.point].push_back(&observation);
  }
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (views[i].size() < 2)
      continue;
    const Eigen::Vector3d& position = *reconstruction.points[i];
    // Derivatives of the whitened pixels.
    const auto rows = static_cast<Eigen::Index>(2 * views[i].size());
    Eigen::MatrixXd by_parameters = Eigen::MatrixXd::Zero(rows, information_.cols());
    Eigen::MatrixX3d by_point = Eigen::MatrixX3d::Zero(rows, 3);
    Eigen::VectorXd residual = Eigen::VectorXd::Zero(rows);
    Eigen::Index row = 0;
    for (const Observation* view : views[i]) {
      const auto projection =
          geometry::projectionOf(reconstruction.cameras[view->camera], position);
      if (!projection)
        continue;
      const Eigen::Vector2d error = view->pixel - projection->pixel;
      by_parameters.block<2, kPoseSize>(row, poseColumn(view->camera)) =
          projection->by_parameters.leftCols<kPoseSize>() / stddev;
      by_parameters.block<2, kIntrinsicsSize>(row, lensColumn(view->camera)) =
          projection->by_parameters.middleCols<kIntrinsicsSize>(geometry::kIntrinsics) / stddev;
      by_point.middleRows<2>(row) = projection->by_point / stddev;
      residual.segment<2>(row) = error / stddev;
      row += 2;
    }
    const Eigen::Matrix3d covariance = (by_point.transpose() * by_point).inverse();
    points_.push_back({position, covariance, -covariance * by_point.transpose() * by_parameters});
    const Eigen::MatrixXd eliminated = by_parameters + by_point * points_.back().by_parameters;
    information_ += by_parameters.transpose() * eliminated;
    gradient_ += eliminated.transpose() * residual;
  }
}

/// Adds the prior Options::lens without its focal length.
void Certainty::addLensPrior(const Reconstruction& reconstruction, const Options& options) {
  const LensPrior& prior = options.lens;
  for (std::size_t camera = 0; camera < (one_lens_ ? 1 : camera_count_); ++camera) {
    const geometry::Intrinsics& lens = reconstruction.cameras[camera].intrinsics;
    const Eigen::Index first = lensColumn(camera);
    using Lens = Eigen::Matrix<double, kIntrinsicsSize, 1>;
    const auto add = [&](const Lens& by_lens, double residual) {
      information_.block<kIntrinsicsSize, kIntrinsicsSize>(first, first) +=
          by_lens * by_lens.transpose();
      gradient_.segment<kIntrinsicsSize>(first) -= by_lens * residual;
    };
    Lens by_aspect = Lens::Zero();
    by_aspect[0] = 1.0 / (lens.fx * prior.aspect);
    by_aspect[1] = -1.0 / (lens.fy * prior.aspect);
    add(by_aspect, std::log(lens.fx / lens.fy) / prior.aspect);
    const double center = prior.principal_point * lens.width;
    add(Lens::Unit(2) / center, (lens.cx - 0.5 * (lens.width - 1)) / center);
    add(Lens::Unit(3) / center, (lens.cy - 0.5 * (lens.height - 1)) / center);
    for (std::size_t k = 0; k < prior.distortion.size(); ++k)
      add(Lens::Unit(4 + static_cast<Eigen::Index>(k)) / prior.distortion[k],
          lens.distortion[k] / prior.distortion[k]);
  }
}

/// The pose of the first camera and its distance to the farthest one define the world.
void Certainty::fixWorld(const Reconstruction& reconstruction) {
  const Eigen::Vector3d origin = reconstruction.cameras.front().center();
  std::size_t farthest = 0;
  Eigen::Vector3d baseline = Eigen::Vector3d::Zero();
  for (std::size_t camera = 1; camera < camera_count_; ++camera) {
    const Eigen::Vector3d to = reconstruction.cameras[camera].center() - origin;
    if (to.norm() > baseline.norm()) {
      baseline = to;
      farthest = camera;
    }
  }
  // Large against what the observations say, but not so large that these drown in rounding errors.
  const double kExact = 1e4;
  information_.diagonal().segment<kPoseSize>(poseColumn(0)) *= 1.0 + kExact;
  const Eigen::Index position = poseColumn(farthest) + geometry::kPosition;
  auto block = information_.block<3, 3>(position, position);
  const Eigen::Vector3d along = baseline.normalized();
  block += kExact * block.norm() * along * along.transpose();
}

std::optional<Eigen::MatrixXd> Certainty::lensCovariance(std::size_t camera) const {
  if (!covariance_)
    return std::nullopt;
  const Eigen::Index first = lensColumn(camera);
  return Eigen::MatrixXd(covariance_->block(first, first, kIntrinsicsSize, kIntrinsicsSize));
}

Eigen::VectorXd Certainty::lensStep(std::size_t camera) const {
  return covariance_->middleRows(lensColumn(camera), kIntrinsicsSize) * gradient_;
}

/// The points' covariance is P + D C D^T: P of each point for exact cameras, C of the cameras, and
/// D how the points move with them. Its trace, less what lies along the motions Q of a similarity.
std::optional<double> Certainty::expectedShapeError() const {
  if (!covariance_)
    return std::nullopt;
  std::vector<Eigen::Vector3d> positions;
  for (const Point& point : points_)
    positions.push_back(point.position);
  const Eigen::MatrixXd motions = geometry::orthonormalBasis(similarityMotions(positions));
  Eigen::MatrixXd along = Eigen::MatrixXd::Zero(7, covariance_->rows());  // Q^T D
  double sum = 0.0;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Point& point = points_[i];
    const auto motion = motions.middleRows<3>(3 * static_cast<Eigen::Index>(i));
    sum += point.covariance.trace() +
           geometry::propagated(point.by_parameters, *covariance_).trace() -
           (motion.transpose() * point.covariance * motion).trace();
    along += motion.transpose() * point.by_parameters;
  }
  sum -= geometry::propagated(along, *covariance_).trace();
  return std::sqrt(sum / static_cast<double>(points_.size()));
}

}  // namespace wiimote_tracker::bundle
