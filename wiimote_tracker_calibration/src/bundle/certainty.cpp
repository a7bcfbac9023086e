#include "steps.h"

#include "wiimote_tracker_calibration/bundle/similarity.h"
#include "wiimote_tracker_calibration/bundle/statistics.h"

#include <wiimote_tracker_triangulation/geometry/linear_algebra.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace wiimote_tracker::bundle {

namespace {

constexpr int kPoseSize = 6;
constexpr int kIntrinsicsSize = 9;
// So many points or up to twice as many, at equal intervals, stand for all of them.
constexpr std::size_t kSample = 100;

/// Plain least squares, weighted by the noise, without the prior of the focal length.
Options weighing(const Options& options, double pixel_stddev) {
  Options result = options;
  result.loss_scale = std::numeric_limits<double>::infinity();
  result.pixel_stddev = pixel_stddev;
  result.lens.focal_length = std::numeric_limits<double>::infinity();
  return result;
}

}  // namespace

double pixelStddev(const Reconstruction& reconstruction, const Options& options) {
  const Statistics errors = statistics(reconstruction);
  const auto inliers = static_cast<double>(errors.inliers);
  const auto points =
      static_cast<double>(std::count_if(reconstruction.points.begin(), reconstruction.points.end(),
                                        [](const auto& point) { return point.has_value(); }));
  const auto cameras = static_cast<double>(reconstruction.cameras.size());
  const double lenses = options.fixed_lenses ? 0.0 : options.one_lens ? 1.0 : cameras;
  // A similarity is not observed.
  const double parameters = cameras * kPoseSize + lenses * kIntrinsicsSize + 3.0 * points - 7.0;
  return errors.rms * std::sqrt(inliers / std::max(1.0, 2.0 * inliers - parameters));
}

Certainty::Certainty(const Reconstruction& reconstruction, const Options& options)
    : one_lens_(options.one_lens),
      pixel_stddev_(pixelStddev(reconstruction, options)),
      reconstruction_(reconstruction),
      problem_(&reconstruction_, weighing(options, pixel_stddev_)) {
  problem_.addScale();
  lenses_ = problem_.estimate({});
}

Eigen::Index Certainty::columnOf(std::size_t camera) const {
  return one_lens_ ? 0 : kIntrinsicsSize * static_cast<Eigen::Index>(camera);
}

std::optional<Eigen::MatrixXd> Certainty::lensCovariance(std::size_t camera) const {
  if (!lenses_)
    return std::nullopt;
  const Eigen::Index first = columnOf(camera);
  return Eigen::MatrixXd(pixel_stddev_ * pixel_stddev_ *
                         lenses_->covariance.block(first, first, kIntrinsicsSize, kIntrinsicsSize));
}

Eigen::VectorXd Certainty::lensStep(std::size_t camera) const {
  return lenses_->step.segment(columnOf(camera), kIntrinsicsSize);
}

/// The trace of the points' covariance, less what lies along the motions of a similarity.
std::optional<double> Certainty::expectedShapeError() {
  std::vector<std::size_t> sample;
  std::vector<Eigen::Vector3d> positions;
  const std::size_t stride = std::max<std::size_t>(1, reconstruction_.points.size() / kSample);
  for (std::size_t i = 0; i < reconstruction_.points.size(); i += stride) {
    if (!reconstruction_.points[i])
      continue;
    sample.push_back(i);
    positions.push_back(*reconstruction_.points[i]);
  }
  const auto joint = problem_.estimate(sample);
  if (!joint || sample.size() < 3)
    return std::nullopt;
  const auto size = static_cast<Eigen::Index>(3 * sample.size());
  const Eigen::MatrixXd covariance = joint->covariance.bottomRightCorner(size, size);
  const Eigen::MatrixXd motions = geometry::orthonormalBasis(similarityMotions(positions));
  const double left =
      covariance.trace() - geometry::propagated(motions.transpose(), covariance).trace();
  return pixel_stddev_ * std::sqrt(left / static_cast<double>(sample.size()));
}

}  // namespace wiimote_tracker::bundle
