#include "continuous/adjust_rig.h"

#include "adjust/camera_blocks.h"
#include "adjust/chi_squared.h"
#include "adjust/covariance.h"
#include "adjust/joint_prior.h"
#include "adjust/moving_pixel.h"
#include "adjust/solver.h"
#include "continuous/keyframes.h"

#include <wiimote_tracker_msgs/median.h>
#include <wiimote_tracker_triangulation/geometry/camera_parameters.h>
#include <wiimote_tracker_triangulation/geometry/linear_algebra.h>

#include <ceres/problem.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace wiimote_tracker::continuous {

namespace {

using adjust::CameraBlocks;
using geometry::firstParameter;
using geometry::kDistortion;
using geometry::kParameters;
using geometry::kPosition;
using geometry::kRotation;
using geometry::kTimeOffset;

// Gates of the keyframes: of the first rounds, which a new clock needs, [px]; of the final rounds
// [standard deviations]; of a check [px].
constexpr double kWideGates[] = {30.0, 10.0, 5.0};
constexpr double kGate = 3.0;
constexpr double kCheckGate = 10.0;
constexpr int kFinalRounds = 2;
// In the first rounds: scale of the robust loss, and standard deviation of a spot [px].
constexpr double kLoss = 3.0;
constexpr double kPixel = 0.5;
constexpr int kSteps = 10;                   // Of the solver, in each round.
constexpr std::size_t kLeastKeyframes = 40;  // As DriftWatch needs for a judgement.
constexpr double kLeastExtent = 0.1;         // Of the keyframes, standard deviation [m].
constexpr Eigen::Index kPose = 6;            // Parameters of a pose: rotation, position.
// Least variance of a parameter: one that was held has none.
constexpr double kHeldVariance = 1e-12;

// How far a camera may have turned since the rig was solved, standard deviation per axis: at once,
// with time, at most. It moves by the lever times the angle. These are assumed. The benchmark
// drifts by 0.4 mrad an hour. In its eight hours, chi-squared in isWithinDrift() is at most 4; the
// limit is 51. Where another LED was followed, it was over 1,100.
constexpr double kDriftAtOnce = 0.0001;       // [rad]
constexpr double kDriftRate = 0.0005 / 3600;  // [rad/s]
constexpr double kWidestDrift = 0.002;        // [rad]
constexpr double kLever = 0.1;                // [m]

// Error of the stamps that changes slowly [s].
constexpr double kOffsetStddev = 0.0001;
// How far a known time offset may have changed against the others': clocks wander, and a driver
// that was started again may use another link [s].
constexpr double kWander = 0.001;
// Prior of the time offset in a new epoch, around 0 [s]. As wide as the benchmark draws it: unlike
// capture::kUnknownOffset it is estimated.
constexpr double kNewOffsetStddev = 0.02;

/// The rig with its covariance widened by turns of the cameras [rad], standard deviation per axis.
geometry::Rig withTurns(geometry::Rig rig, double turn) {
  if (!geometry::hasCovariance(rig))
    return rig;
  const double move = kLever * turn;
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    auto variance = rig.covariance.diagonal().segment<kParameters>(firstParameter(i));
    variance.segment<3>(kRotation).array() += turn * turn;
    variance.segment<3>(kPosition).array() += move * move;
  }
  return rig;
}

/// The rig with the drift since, and the clocks' latest epochs.
geometry::Rig priorOf(const geometry::Rig& rig, const KeyframeSource& source, double time) {
  geometry::Rig prior = withDrift(rig, time);
  std::vector<Eigen::Index> clocks;  // That are known.
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    geometry::RigCamera& camera = prior.cameras[i];
    const Eigen::Index first = firstParameter(i);
    const Eigen::Index clock = first + kTimeOffset;
    const auto epoch = source.epoch(i);
    const bool known = camera.timeOffsetIn(epoch.value_or(camera.time_offset_epoch)).has_value();
    if (known) {
      clocks.push_back(clock);
    } else {
      camera.time_offset = 0.0;
      camera.time_offset_rule = geometry::TimeOffsetRule::kOneEpoch;
      camera.time_offset_epoch = epoch.value_or(0);
      prior.covariance.row(clock).setZero();
      prior.covariance.col(clock).setZero();
    }
    const double offset = known ? kOffsetStddev : kNewOffsetStddev;
    prior.covariance(clock, clock) += offset * offset;
    prior.covariance.diagonal().segment<kTimeOffset>(first).array() += kHeldVariance;
  }
  // The images show none of what all clocks did together.
  for (const Eigen::Index a : clocks) {
    prior.covariance(a, a) += kWander * kWander;
    for (const Eigen::Index b : clocks)
      prior.covariance(a, b) -= kWander * kWander / static_cast<double>(clocks.size());
  }
  return prior;
}

/// Shifts all time offsets so that those that were known have not changed, in the median.
void keepTime(const geometry::Rig& before, const KeyframeSource& source, geometry::Rig* adjusted) {
  std::vector<double> changes;
  for (std::size_t i = 0; i < before.cameras.size(); ++i) {
    const auto epoch = source.epoch(i);
    const auto known = epoch ? before.cameras[i].timeOffsetIn(*epoch) : std::nullopt;
    if (known)
      changes.push_back(adjusted->cameras[i].time_offset - *known);
  }
  if (changes.empty())
    return;
  const double change = medianOf(&changes);
  for (std::size_t i = 0; i < before.cameras.size(); ++i) {
    if (source.epoch(i))
      adjusted->cameras[i].time_offset -= change;
  }
}

/// The same covariance with that of the clocks against their mean. What all clocks do together
/// moves no point, and no image shows it; only errors of the views' velocities seem to. Where
/// correlations are left out, as in copyClock(), it would count as an error of each clock. Of all
/// references the mean gives the clocks the least variances (S-transformation, Baarda 1973).
Eigen::MatrixXd withoutCommonClock(const KeyframeSource& source,
                                   const Eigen::MatrixXd& covariance) {
  Eigen::VectorXd common = Eigen::VectorXd::Zero(covariance.rows());
  for (Eigen::Index i = 0; i < covariance.rows() / kParameters; ++i) {
    if (source.epoch(static_cast<std::size_t>(i)))
      common[kParameters * i + kTimeOffset] = 1.0;
  }
  const Eigen::MatrixXd others = Eigen::MatrixXd::Identity(common.size(), common.size()) -
                                 common * common.transpose() / common.sum();
  return geometry::propagated(others, covariance);
}

/// Sets to zero what the prior says of coefficients that a lens does not have: a rig must not.
Eigen::MatrixXd ofExistingCoefficients(const geometry::Rig& rig, Eigen::MatrixXd covariance) {
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    const auto coefficients = static_cast<Eigen::Index>(
        geometry::coefficientCount(rig.cameras[i].camera.intrinsics.distortion_model));
    for (Eigen::Index k = kDistortion + coefficients; k < kTimeOffset; ++k) {
      covariance.row(firstParameter(i) + k).setZero();
      covariance.col(firstParameter(i) + k).setZero();
    }
  }
  return covariance;
}

/// Whether there are enough, and they do not lie together.
bool areSpread(const std::vector<Keyframe>& keyframes) {
  std::vector<Eigen::Vector3d> points;
  for (const Keyframe& keyframe : keyframes)
    points.push_back(keyframe.point);
  return points.size() >= kLeastKeyframes && geometry::spreadOf(points).norm() > kLeastExtent;
}

/// The keyframes and the prior around the present values of the cameras' blocks.
class RigProblem {
 public:
  RigProblem(const geometry::Rig& prior,
             std::vector<Keyframe> keyframes,
             double pixel_stddev,
             double loss_scale,
             std::vector<CameraBlocks>* cameras)
      : keyframes_(std::move(keyframes)), blocks_(adjust::blocksOf(cameras)) {
    for (Keyframe& keyframe : keyframes_) {
      for (const View& view : keyframe.views) {
        CameraBlocks& camera = (*cameras)[view.camera];
        const adjust::InterpolatedPixelError error{
            adjust::PixelError(camera, view.pixel, pixel_stddev), view.velocity,
            *camera.timeOffset()};
        camera.addTo(&problem_, error.cost(), adjust::lossOf(loss_scale), camera.timeOffset(),
                     keyframe.point.data());
      }
    }
    addPrior(prior);
  }

  /// Changes the cameras' blocks. @returns whether it could.
  bool solve() {
    std::vector<double*> points;
    for (Keyframe& keyframe : keyframes_)
      points.push_back(keyframe.point.data());
    return adjust::minimise(adjust::solverOptionsForPoints(problem_, points, kSteps), &problem_)
        .IsSolutionUsable();
  }

  std::optional<Eigen::MatrixXd> covariance() { return adjust::covarianceOf(&problem_, blocks_); }

 private:
  void addPrior(const geometry::Rig& prior) {
    std::vector<double> mean;
    std::vector<std::int32_t> sizes;
    for (const geometry::RigCamera& camera : prior.cameras) {
      const CameraBlocks start(camera.camera, camera.time_offset);
      mean.insert(mean.end(), start.values.begin(), start.values.end());
      sizes.insert(sizes.end(), CameraBlocks::kSizes.begin(), CameraBlocks::kSizes.end());
    }
    problem_.AddResidualBlock(
        new adjust::JointPrior(Eigen::Map<Eigen::VectorXd>(mean.data(), prior.covariance.rows()),
                               prior.covariance, sizes),
        nullptr, blocks_);
  }

  std::vector<Keyframe> keyframes_;
  std::vector<double*> blocks_;  // of all cameras, as in the rig's covariance
  ceres::Problem problem_;
};

/// Alternates between keyframes and solutions.
class Adjustment {
 public:
  Adjustment(const geometry::Rig& prior, const KeyframeSource& source)
      : prior_(prior), source_(source), rig_(prior) {
    for (const geometry::RigCamera& camera : prior.cameras)
      cameras_.emplace_back(camera.camera, camera.time_offset);
  }

  std::optional<geometry::Rig> solve() {
    for (const double gate : kWideGates) {
      if (!round(gate, kPixel, kLoss / kPixel))
        return std::nullopt;
    }
    for (int i = 0; i < kFinalRounds; ++i) {
      const double stddev = rmsResidual(source_.keyframes(rig_, kWideGates[2]));
      // The gate is for both axes together.
      if (!round(std::sqrt(2.0) * kGate * stddev, stddev, std::numeric_limits<double>::infinity()))
        return std::nullopt;
    }
    return rig_;
  }

 private:
  /// @returns whether there was enough to solve.
  bool round(double gate, double pixel_stddev, double loss_scale) {
    std::vector<Keyframe> keyframes = source_.keyframes(rig_, gate);
    if (!areSpread(keyframes))
      return false;
    RigProblem problem(prior_, std::move(keyframes), pixel_stddev, loss_scale, &cameras_);
    if (!problem.solve())
      return false;
    for (std::size_t i = 0; i < cameras_.size(); ++i) {
      rig_.cameras[i].camera = cameras_[i].cameraLike(rig_.cameras[i].camera);
      rig_.cameras[i].time_offset = *cameras_[i].timeOffset();
    }
    if (std::isfinite(loss_scale))
      return true;
    const auto covariance = problem.covariance();
    if (covariance)
      rig_.covariance = ofExistingCoefficients(rig_, *covariance);
    return covariance.has_value();
  }

  const geometry::Rig& prior_;
  const KeyframeSource& source_;
  geometry::Rig rig_;
  std::vector<CameraBlocks> cameras_;
};

}  // namespace

double driftUntil(double time, const geometry::Rig& rig) {
  return std::min(kDriftAtOnce + kDriftRate * std::abs(time - rig.solved_at), kWidestDrift);
}

geometry::Rig withDrift(geometry::Rig rig, double time) {
  const double turn = driftUntil(time, rig);
  return withTurns(std::move(rig), turn);
}

bool isWithinDrift(const geometry::Rig& rig, const geometry::Rig& adjusted) {
  const Eigen::MatrixXd all = withTurns(rig, kWidestDrift).covariance;
  const auto cameras = static_cast<Eigen::Index>(rig.cameras.size());
  Eigen::VectorXd change(kPose * cameras);
  Eigen::MatrixXd covariance(kPose * cameras, kPose * cameras);
  for (Eigen::Index i = 0; i < cameras; ++i) {
    const auto index = static_cast<std::size_t>(i);
    const geometry::Camera& from = rig.cameras[index].camera;
    const geometry::Camera& to = adjusted.cameras[index].camera;
    const Eigen::AngleAxisd turn(to.world_from_camera.linear() *
                                 from.world_from_camera.linear().transpose());
    change.segment<kPose>(kPose * i) << turn.angle() * turn.axis(), to.center() - from.center();
    for (Eigen::Index k = 0; k < cameras; ++k) {
      covariance.block<kPose, kPose>(kPose * i, kPose * k) = all.block<kPose, kPose>(
          firstParameter(index), firstParameter(static_cast<std::size_t>(k)));
    }
  }
  return geometry::squaredMahalanobis(change, covariance) <
         adjust::chiSquaredQuantile(static_cast<double>(change.size()), adjust::kThreeNines);
}

std::optional<geometry::Rig> adjustRig(const geometry::Rig& rig,
                                       const std::vector<capture::Image>& images) {
  if (!geometry::hasCovariance(rig) || rig.ray_model != geometry::RayModel::kCalibrated ||
      images.empty())
    return std::nullopt;
  const KeyframeSource source(rig, images);
  const geometry::Rig prior = priorOf(rig, source, images.back().stamp);
  auto adjusted = Adjustment(prior, source).solve();
  if (!adjusted)
    return std::nullopt;
  keepTime(rig, source, &*adjusted);
  adjusted->covariance = withoutCommonClock(source, adjusted->covariance);
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    const Eigen::Index clock = firstParameter(i) + kTimeOffset;
    adjusted->covariance(clock, clock) += kOffsetStddev * kOffsetStddev;
    if (rig.cameras[i].time_offset_rule == geometry::TimeOffsetRule::kNone)
      copyClock(rig, i, &*adjusted);
  }
  return adjusted;
}

void copyClock(const geometry::Rig& from, std::size_t camera, geometry::Rig* to) {
  const geometry::RigCamera& source = from.cameras[camera];
  to->cameras[camera].time_offset = source.time_offset;
  to->cameras[camera].time_offset_rule = source.time_offset_rule;
  to->cameras[camera].time_offset_epoch = source.time_offset_epoch;
  const Eigen::Index clock = firstParameter(camera) + kTimeOffset;
  to->covariance.row(clock).setZero();
  to->covariance.col(clock).setZero();
  to->covariance(clock, clock) = from.covariance(clock, clock);
}

std::optional<Fit> fitOf(const geometry::Rig& rig, const std::vector<capture::Image>& images) {
  const KeyframeSource source(rig, images);
  geometry::Rig valid = rig;
  for (std::size_t i = 0; i < rig.cameras.size(); ++i)
    valid.cameras[i].time_offset =
        rig.cameras[i].timeOffsetIn(source.epoch(i).value_or(0)).value_or(0.0);
  const auto keyframes = source.keyframes(valid, kCheckGate);
  if (keyframes.size() < kLeastKeyframes)
    return std::nullopt;
  Fit fit{rmsResidual(keyframes), {}};
  for (const Keyframe& keyframe : keyframes)
    fit.places.push_back(keyframe.point);
  return fit;
}

}  // namespace wiimote_tracker::continuous
