#include "resection.h"

#include "recalibrate/error.h"

#include <wiimote_tracker_triangulation/geometry/so3.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace wiimote_tracker::recalibrate {

namespace {

// Time offsets tried first, around the prior mean [s].
constexpr double kFarthestOffset = 0.05;
constexpr double kOffsetStep = 0.01;
// Number of points used in the search for a first pose.
constexpr std::size_t kSearchPoints = 150;
constexpr std::size_t kMinimumMatches = 100;
// Gates: first in px, then in standard deviations.
constexpr double kWideGates[] = {30.0, 15.0};
constexpr double kGate = 4.0;
constexpr int kFinalRounds = 12;
constexpr int kSteps = 4;  // Gauss-Newton steps from one matching to the next.
// Convergence: relative change of the noise, change of the time offset.
constexpr double kNoiseTolerance = 0.01;
constexpr double kOffsetTolerance = 1e-6;  // [s]

struct Pose {
  geometry::Camera camera;
  double time_offset = 0.0;
  std::size_t support = 0;
};

/// A first pose from points and pixels at one time offset.
std::optional<Pose> searchPose(const SeenPath& path,
                               const std::vector<capture::Image>& images,
                               geometry::Camera camera,
                               double time_offset) {
  const std::size_t stride = std::max<std::size_t>(1, images.size() / kSearchPoints);
  std::vector<cv::Point3d> points;
  std::vector<cv::Point2d> pixels;
  for (std::size_t i = 0; i < images.size(); i += stride) {
    if (images[i].spots.size() != 1)
      continue;
    PathPoint point;
    const auto normalized = camera.intrinsics.normalizedFromPixel(images[i].spots.front());
    if (!normalized || path.at(images[i].stamp + time_offset, &point) != SeenPath::Sight::kSeen)
      continue;
    points.emplace_back(point.position.x(), point.position.y(), point.position.z());
    pixels.emplace_back(normalized->x(), normalized->y());
  }
  if (points.size() < 12)
    return std::nullopt;
  cv::Mat rotation_vector;
  cv::Mat translation;
  std::vector<int> inliers;
  const double threshold = kWideGates[1] / camera.intrinsics.fx;
  try {
    if (!cv::solvePnPRansac(points, pixels, cv::Mat::eye(3, 3, CV_64F), cv::noArray(),
                            rotation_vector, translation, false, 200, static_cast<float>(threshold),
                            0.999, inliers, cv::SOLVEPNP_EPNP))
      return std::nullopt;
  } catch (const cv::Exception&) {
    return std::nullopt;  // degenerate points
  }
  cv::Mat rotation;
  cv::Rodrigues(rotation_vector, rotation);
  Eigen::Isometry3d camera_from_world = Eigen::Isometry3d::Identity();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column)
      camera_from_world.matrix()(row, column) = rotation.at<double>(row, column);
    camera_from_world.matrix()(row, 3) = translation.at<double>(row);
  }
  if (!camera_from_world.matrix().allFinite())
    return std::nullopt;
  camera.world_from_camera = camera_from_world.inverse();
  return Pose{camera, time_offset, inliers.size()};
}

Pose firstPose(const SeenPath& path,
               const std::vector<capture::Image>& images,
               const geometry::Camera& start,
               const Prior& prior) {
  std::optional<Pose> best;
  const bool offset_known =
      prior.covariance(geometry::kTimeOffset, geometry::kTimeOffset) < kOffsetStep * kOffsetStep;
  const int steps = offset_known ? 0 : static_cast<int>(std::lround(kFarthestOffset / kOffsetStep));
  for (int step = -steps; step <= steps; ++step) {
    auto pose = searchPose(path, images, start, prior.time_offset + kOffsetStep * step);
    if (pose && (!best || pose->support > best->support))
      best = pose;
  }
  if (!best)
    throw RecalibrateError(
        "no place of " + start.name +
        " explains what it saw: check that it sees the same LED as the others and no other light, "
        "that it stays where it is, and wave again");
  return *best;
}

/// Associates with each image its best spot within the gate.
void matchSpots(const SeenPath& path,
                const std::vector<capture::Image>& images,
                double gate,
                double gate_px,
                double stamp_stddev,
                Fit* fit) {
  fit->matches.clear();
  fit->duration = images.empty() ? 0.0 : images.back().stamp - images.front().stamp;
  fit->expected = 0;
  fit->contradictory = 0;
  for (const capture::Image& image : images) {
    if (image.spots.empty())
      continue;
    Match match;
    const SeenPath::Sight sight = path.at(image.stamp + fit->time_offset, &match.point);
    fit->contradictory += sight == SeenPath::Sight::kContradictory ? 1 : 0;
    if (sight != SeenPath::Sight::kSeen)
      continue;
    ++fit->expected;
    double least = std::numeric_limits<double>::infinity();
    for (const Eigen::Vector2d& spot : image.spots) {
      match.pixel = spot;
      const auto linear = linearize(fit->camera, match, fit->pixel_stddev, stamp_stddev);
      if (!linear)
        continue;
      const double squared = linear->residual.dot(linear->covariance.inverse() * linear->residual);
      const bool near = gate_px > 0.0 ? linear->residual.norm() < gate_px : squared < gate * gate;
      if (!near || squared >= least)
        continue;
      if (std::isfinite(least))
        fit->matches.back() = match;
      else
        fit->matches.push_back(match);
      least = squared;
    }
  }
  if (fit->matches.size() < kMinimumMatches)
    throw RecalibrateError(fit->camera.name + " and two other cameras saw the LED together in " +
                           std::to_string(fit->matches.size()) + " images only, but " +
                           std::to_string(kMinimumMatches) +
                           " are needed: wave longer, where all of them see it");
}

void apply(const ParameterVector& step, geometry::Camera* camera, double* time_offset) {
  const Eigen::Quaterniond rotation = geometry::so3::exp(step.segment<3>(geometry::kRotation)) *
                                      Eigen::Quaterniond(camera->world_from_camera.linear());
  camera->world_from_camera.linear() = rotation.normalized().toRotationMatrix();
  camera->world_from_camera.translation() += step.segment<3>(geometry::kPosition);
  geometry::Intrinsics& lens = camera->intrinsics;
  lens.fx += step[geometry::kLens];
  lens.fy += step[geometry::kLens + 1];
  lens.cx += step[geometry::kLens + 2];
  lens.cy += step[geometry::kLens + 3];
  for (Eigen::Index k = geometry::kDistortion; k < geometry::kTimeOffset; ++k)
    lens.distortion[static_cast<std::size_t>(k - geometry::kDistortion)] += step[k];
  *time_offset += step[geometry::kTimeOffset];
}

/// Lens and time offset minus their prior mean; pose: 0.
ParameterVector deviation(const Fit& fit, const Prior& prior) {
  ParameterVector result = ParameterVector::Zero();
  const geometry::Intrinsics& lens = fit.camera.intrinsics;
  result[geometry::kLens] = lens.fx - prior.lens.fx;
  result[geometry::kLens + 1] = lens.fy - prior.lens.fy;
  result[geometry::kLens + 2] = lens.cx - prior.lens.cx;
  result[geometry::kLens + 3] = lens.cy - prior.lens.cy;
  for (Eigen::Index k = geometry::kDistortion; k < geometry::kTimeOffset; ++k) {
    const auto i = static_cast<std::size_t>(k - geometry::kDistortion);
    result[k] = lens.distortion[i] - prior.lens.distortion[i];
  }
  result[geometry::kTimeOffset] = fit.time_offset - prior.time_offset;
  return result;
}

/// Inverse of the covariance over the parameters that are not held.
ParameterMatrix informationOf(const ParameterMatrix& covariance) {
  std::vector<Eigen::Index> known;
  for (Eigen::Index k = geometry::kLens; k < geometry::kParameters; ++k) {
    if (covariance(k, k) > 0.0)
      known.push_back(k);
  }
  const auto n = static_cast<Eigen::Index>(known.size());
  Eigen::MatrixXd part(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j)
      part(i, j) =
          covariance(known[static_cast<std::size_t>(i)], known[static_cast<std::size_t>(j)]);
  }
  const Eigen::MatrixXd inverse = part.ldlt().solve(Eigen::MatrixXd::Identity(n, n));
  ParameterMatrix information = ParameterMatrix::Zero();
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j)
      information(known[static_cast<std::size_t>(i)], known[static_cast<std::size_t>(j)]) =
          0.5 * (inverse(i, j) + inverse(j, i));
  }
  return information;
}

/// Solves for the free parameters.
ParameterVector solveFree(const ParameterMatrix& matrix,
                          const ParameterVector& right,
                          const std::vector<Eigen::Index>& free) {
  const auto n = static_cast<Eigen::Index>(free.size());
  Eigen::MatrixXd part(n, n);
  Eigen::VectorXd vector(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    vector[i] = right[free[static_cast<std::size_t>(i)]];
    for (Eigen::Index j = 0; j < n; ++j)
      part(i, j) = matrix(free[static_cast<std::size_t>(i)], free[static_cast<std::size_t>(j)]);
  }
  const Eigen::VectorXd solution = part.ldlt().solve(vector);
  ParameterVector result = ParameterVector::Zero();
  for (Eigen::Index i = 0; i < n; ++i)
    result[free[static_cast<std::size_t>(i)]] = solution[i];
  return result;
}

/// Half the sum of squares at a state, and with it the normal equations; infinite when a point
/// cannot be seen from there.
double normalEquations(const Fit& fit,
                       const Prior& prior,
                       double base_offset,
                       double stamp_stddev,
                       ParameterMatrix* information,
                       ParameterVector* gradient) {
  const ParameterVector from_prior = deviation(fit, prior);
  *information = fit.prior_information;
  *gradient = fit.prior_information * from_prior;
  double cost = 0.5 * from_prior.dot(*gradient);
  for (Match match : fit.matches) {
    // Until the next association the LED moves with constant velocity.
    match.point.position += match.point.velocity * (fit.time_offset - base_offset);
    const auto linear = linearize(fit.camera, match, fit.pixel_stddev, stamp_stddev);
    if (!linear)
      return std::numeric_limits<double>::infinity();
    const Eigen::Matrix2d weight = linear->covariance.inverse();
    const Eigen::Matrix<double, geometry::kParameters, 2> weighted =
        linear->jacobian.transpose() * weight;
    information->noalias() += weighted * linear->jacobian;
    gradient->noalias() += weighted * linear->residual;
    cost += 0.5 * linear->residual.dot(weight * linear->residual);
  }
  return cost;
}

/// A few steps of Levenberg-Marquardt with fixed associations.
void adjust(const Prior& prior, double stamp_stddev, Fit* fit) {
  const double base = fit->time_offset;
  ParameterMatrix information;
  ParameterVector gradient;
  double cost = normalEquations(*fit, prior, base, stamp_stddev, &information, &gradient);
  double damping = 1e-6;
  for (int i = 0; i < kSteps; ++i) {
    ParameterMatrix damped = information;
    damped.diagonal() *= 1.0 + damping;
    const ParameterVector step = -solveFree(damped, gradient, fit->free);
    Fit moved = *fit;
    apply(step, &moved.camera, &moved.time_offset);
    ParameterMatrix moved_information;
    ParameterVector moved_gradient;
    const double moved_cost =
        step.allFinite()
            ? normalEquations(moved, prior, base, stamp_stddev, &moved_information, &moved_gradient)
            : std::numeric_limits<double>::infinity();
    if (!(moved_cost <= cost)) {
      damping = std::max(1e-3, 10.0 * damping);
      continue;
    }
    *fit = moved;
    cost = moved_cost;
    information = moved_information;
    gradient = moved_gradient;
    damping *= 0.1;
  }
  fit->information = information;
}

/// Root mean square of the whitened residuals of the matches.
double misfit(const Fit& fit, double stamp_stddev) {
  double squared = 0.0;
  for (const Match& match : fit.matches) {
    if (const auto linear = linearize(fit.camera, match, fit.pixel_stddev, stamp_stddev))
      squared += linear->residual.dot(linear->covariance.inverse() * linear->residual);
  }
  return std::sqrt(squared / (2.0 * static_cast<double>(fit.matches.size())));
}

}  // namespace

std::optional<Linearized> linearize(const geometry::Camera& camera,
                                    const Match& match,
                                    double pixel_stddev,
                                    double stamp_stddev) {
  const auto projection = geometry::projectionOf(camera, match.point.position);
  if (!projection)
    return std::nullopt;
  Linearized linear;
  linear.residual = projection->pixel - match.pixel;
  linear.jacobian = projection->by_parameters;
  linear.by_point = projection->by_point;
  const Eigen::Vector2d by_time = projection->by_point * match.point.velocity;
  linear.jacobian.col(geometry::kTimeOffset) = by_time;
  const double variance = pixel_stddev * pixel_stddev;
  linear.covariance =
      variance * (Eigen::Matrix2d::Identity() + projection->by_point * match.point.unit_covariance *
                                                    projection->by_point.transpose()) +
      stamp_stddev * stamp_stddev * by_time * by_time.transpose();
  return linear;
}

Fit resect(const SeenPath& path,
           const std::vector<capture::Image>& images,
           const geometry::Camera& start,
           const Prior& prior,
           const ResectionOptions& options) {
  const Pose pose = firstPose(path, images, start, prior);
  Fit fit;
  fit.camera = pose.camera;
  fit.time_offset = pose.time_offset;
  fit.pixel_stddev = options.pixel;
  fit.prior_information = informationOf(prior.covariance);
  for (Eigen::Index k = 0; k < geometry::kParameters; ++k) {
    if (k < geometry::kLens || prior.covariance(k, k) > 0.0)
      fit.free.push_back(k);
  }
  for (const double gate : kWideGates) {
    matchSpots(path, images, 0.0, gate, options.stamp, &fit);
    adjust(prior, options.stamp, &fit);
  }
  for (int round = 0; round < kFinalRounds; ++round) {
    const double offset = fit.time_offset;
    matchSpots(path, images, kGate, 0.0, options.stamp, &fit);
    adjust(prior, options.stamp, &fit);
    const double ratio = misfit(fit, options.stamp);
    fit.pixel_stddev *= ratio;
    if (std::abs(ratio - 1.0) < kNoiseTolerance &&
        std::abs(fit.time_offset - offset) < kOffsetTolerance)
      break;
  }
  return fit;
}

}  // namespace wiimote_tracker::recalibrate
