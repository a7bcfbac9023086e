#include "resection.h"

#include "adjust/covariance.h"
#include "adjust/moving_pixel.h"
#include "adjust/prior.h"
#include "adjust/solver.h"
#include "bundle/start.h"
#include "square/lens_priors.h"

#include <wiimote_tracker_msgs/error.h>
#include <wiimote_tracker_msgs/text.h>

#include <ceres/normal_prior.h>
#include <ceres/problem.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace wiimote_tracker::recalibrate {

namespace {

using capture::kLeastSightings;

// Prior of the time offset, as in WaveOptions; offsets so far around its mean are tried first [s].
constexpr double kOffsetStddev = 0.05;
constexpr double kOffsetStep = 0.01;
// Least variance of a lens parameter: one that was held has none [px^2, 1].
constexpr double kLeastVariance = 1e-12;
// Number of points used in the search for a first pose.
constexpr std::size_t kSearchPoints = 150;
constexpr double kRoughError = 4.0;  // of an inlier, of which bundle::resect() takes 4 times [px]
// Gates: first in px, then in standard deviations.
constexpr double kWideGates[] = {30.0, 15.0};
constexpr double kGate = 4.0;
constexpr int kFinalRounds = 12;
constexpr int kSteps = 4;  // of the solver, from one matching to the next
// Convergence: relative change of the noise, change of the time offset.
constexpr double kNoiseTolerance = 0.01;
constexpr double kOffsetTolerance = 1e-6;  // [s]

/// Finds a first pose from points and pixels at one time offset.
/// @returns how many agree with it; 0: there is none.
std::size_t searchPose(const SeenPath& path,
                       const std::vector<capture::Image>& images,
                       double time_offset,
                       geometry::Camera* camera) {
  const std::size_t stride = std::max<std::size_t>(1, images.size() / kSearchPoints);
  bundle::Reconstruction seen;
  seen.cameras = {*camera};
  for (std::size_t i = 0; i < images.size(); i += stride) {
    PathPoint point;
    if (images[i].spots.size() != 1 ||
        path.at(images[i].stamp + time_offset, &point) != SeenPath::Sight::kSeen)
      continue;
    seen.observations.push_back({0, seen.points.size(), images[i].spots.front()});
    seen.points.emplace_back(point.position);
  }
  bundle::Options options;
  options.maximum_error = kRoughError;
  options.rough = true;
  seen.placed = {false};
  if (seen.points.size() < options.minimum_common_points)
    return 0;
  try {
    const std::size_t support = bundle::resect(options, 0, &seen);
    *camera = seen.cameras.front();
    return support;
  } catch (const bundle::BundleError&) {
    return 0;
  }
}

/// Pose and time offset with which most agrees.
Fit firstPose(const SeenPath& path,
              const std::vector<capture::Image>& images,
              const geometry::Camera& start,
              double time_offset) {
  Fit fit;
  std::size_t most = 0;
  const int steps = static_cast<int>(std::lround(kOffsetStddev / kOffsetStep));
  for (int step = -steps; step <= steps; ++step) {
    geometry::Camera camera = start;
    const double offset = time_offset + kOffsetStep * step;
    const std::size_t support = searchPose(path, images, offset, &camera);
    if (support <= most)
      continue;
    most = support;
    fit.camera = camera;
    fit.time_offset = offset;
  }
  if (most == 0)
    throw Error(
        "no place of " + start.name +
        " explains what it saw: check that it sees the same LED as the others and no other light, "
        "that it stays where it is, and wave again");
  return fit;
}

/// Inverse square root of the covariance of a spot against the expected pixel [1/px]: errors of the
/// spot, of the spots that the LED was triangulated from, and of the stamp.
Eigen::Matrix2d whiteningOf(const geometry::Projection& expected,
                            const PathPoint& point,
                            double pixel_stddev,
                            double wander) {
  const Eigen::Vector2d by_stamp = wander * expected.by_parameters.col(geometry::kTimeOffset);
  const Eigen::Matrix2d covariance =
      pixel_stddev * pixel_stddev *
          (Eigen::Matrix2d::Identity() +
           expected.by_point * point.unit_covariance * expected.by_point.transpose()) +
      by_stamp * by_stamp.transpose();
  return Eigen::LLT<Eigen::Matrix2d>(covariance).matrixL().solve(Eigen::Matrix2d::Identity());
}

/// The best spot of an image within a gate. @param gate_px [px]; nothing: kGate.
std::optional<Match> matchOf(const capture::Image& image,
                             const PathPoint& point,
                             std::optional<double> gate_px,
                             double wander,
                             const Fit& fit) {
  const auto expected = projectionOf(fit.camera, point);
  if (!expected)
    return std::nullopt;
  const Eigen::Matrix2d whitening = whiteningOf(*expected, point, fit.pixel_stddev, wander);
  std::optional<Match> best;
  double least = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector2d& spot : image.spots) {
    const Eigen::Vector2d residual = expected->pixel - spot;
    const double deviation = (whitening * residual).norm();
    const bool near = gate_px ? residual.norm() < *gate_px : deviation < kGate;
    if (!near || deviation >= least)
      continue;
    least = deviation;
    best = Match{point, spot, whitening};
  }
  return best;
}

/// Associates with each image its best spot within the gate, as matchOf().
void matchSpots(const SeenPath& path,
                const std::vector<capture::Image>& images,
                std::optional<double> gate_px,
                double wander,
                Fit* fit) {
  const double duration = images.back().stamp - images.front().stamp;
  *fit = Fit{fit->camera, fit->time_offset, fit->pixel_stddev, {}, duration};
  for (const capture::Image& image : images) {
    if (image.spots.empty())
      continue;
    PathPoint point;
    const SeenPath::Sight sight = path.at(image.stamp + fit->time_offset, &point);
    fit->undetermined += sight == SeenPath::Sight::kUndetermined ? 1 : 0;
    fit->contradictory += sight == SeenPath::Sight::kContradictory ? 1 : 0;
    if (sight != SeenPath::Sight::kSeen)
      continue;
    ++fit->expected;
    if (const auto match = matchOf(image, point, gate_px, wander, *fit))
      fit->matches.push_back(*match);
  }
  if (fit->expected < kLeastSightings)
    throw Error(fit->camera.name + " and two other cameras saw the LED together in " +
                std::to_string(fit->expected) + " images only, but " +
                std::to_string(kLeastSightings) +
                " are needed: wave longer, where all of them see it");
  if (fit->matches.size() < kLeastSightings)
    throw Error(
        format("only %zu of %zu images of %s fit to what the others saw: it moved while the LED "
               "was waved, sees another light, or the others are known too badly; wave again, or "
               "calibrate all of them again",
               fit->matches.size(), fit->expected, fit->camera.name.c_str()));
}

/// The matches of a fit and the prior as a problem of Ceres.
class ResectionProblem {
 public:
  ResectionProblem(const Fit& fit, const Prior& prior) : blocks_(fit.camera, fit.time_offset) {
    for (const Match& match : fit.matches) {
      // Until the next association the LED moves with constant velocity.
      const adjust::MovingPixelError error{
          adjust::PixelError(blocks_, match.pixel, match.whitening), match.point.position,
          match.point.velocity, fit.time_offset};
      matches_.push_back(blocks_.addTo(&problem_, error.cost(), nullptr, blocks_.timeOffset()));
    }
    problem_.SetParameterBlockConstant(blocks_.higherDistortion());
    problem_.AddResidualBlock(adjust::priorOf(prior.time_offset, kOffsetStddev), nullptr,
                              blocks_.timeOffset());
    problem_.AddResidualBlock(lensCost(prior), nullptr, blocks_.lens());
  }

  void solve(Fit* fit) {
    adjust::minimise(adjust::solverOptions(ceres::DENSE_QR, kSteps), &problem_);
    fit->camera = blocks_.cameraLike(fit->camera);
    fit->time_offset = *blocks_.timeOffset();
  }

  /// Root mean square of the whitened residuals of the matches.
  double noiseRatio() {
    const double residuals = 2.0 * static_cast<double>(matches_.size());
    return std::sqrt(adjust::squaresOf(&problem_, matches_) / residuals);
  }

  std::optional<Eigen::MatrixXd> covariance() {
    return adjust::covarianceOf(&problem_, blocks_.all());
  }

 private:
  static ceres::CostFunction* lensCost(const Prior& prior) {
    if (!prior.lens_covariance)
      return square::marginalLensPrior(prior.lens, prior.uncertainty).cost();
    const geometry::Intrinsics& lens = prior.lens;
    Eigen::VectorXd mean(adjust::kLensSize);
    mean << lens.fx, lens.fy, lens.cx, lens.cy, lens.distortion[0];
    return new ceres::NormalPrior(Eigen::MatrixXd(prior.lensInformation().llt().matrixU()), mean);
  }

  adjust::CameraBlocks blocks_;
  ceres::Problem problem_;
  std::vector<ceres::ResidualBlockId> matches_;
};

}  // namespace

LensMatrix Prior::lensInformation() const {
  return LensMatrix(*lens_covariance + kLeastVariance * LensMatrix::Identity()).inverse();
}

std::optional<geometry::Projection> projectionOf(const geometry::Camera& camera,
                                                 const PathPoint& point) {
  auto projection = geometry::projectionOf(camera, point.position);
  if (projection)
    projection->by_parameters.col(geometry::kTimeOffset) = projection->by_point * point.velocity;
  return projection;
}

Fit resect(const SeenPath& path,
           const std::vector<capture::Image>& images,
           const geometry::Camera& start,
           const Prior& prior,
           const Options& options) {
  if (images.size() < kLeastSightings)
    throw Error(start.name + " sent " + std::to_string(images.size()) + " images only, but " +
                std::to_string(kLeastSightings) + " are needed: wave longer");
  Fit fit = firstPose(path, images, start, prior.time_offset);
  fit.pixel_stddev = options.pixel;
  for (const double gate : kWideGates) {
    matchSpots(path, images, gate, options.wander, &fit);
    ResectionProblem(fit, prior).solve(&fit);
  }
  for (int round = 0; round < kFinalRounds; ++round) {
    const double offset = fit.time_offset;
    matchSpots(path, images, std::nullopt, options.wander, &fit);
    ResectionProblem problem(fit, prior);
    problem.solve(&fit);
    const double ratio = problem.noiseRatio();
    fit.pixel_stddev *= ratio;
    if (std::abs(ratio - 1.0) < kNoiseTolerance &&
        std::abs(fit.time_offset - offset) < kOffsetTolerance)
      break;
  }
  return fit;
}

ParameterMatrix covarianceOf(const Fit& fit, const Prior& prior) {
  const auto covariance = ResectionProblem(fit, prior).covariance();
  if (!covariance)
    throw Error("what " + fit.camera.name +
                " saw does not determine where it is: wave the LED through the whole "
                "volume");
  return *covariance;
}

}  // namespace wiimote_tracker::recalibrate
