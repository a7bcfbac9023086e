#include "recalibrate/recalibrate_camera.h"

#include "resection.h"
#include "seen_path.h"

#include <wiimote_tracker_triangulation/geometry/point_sensitivity.h>
#include "recalibrate/error.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace wiimote_tracker::recalibrate {

namespace {

using geometry::firstParameter;
using geometry::kDistortion;
using geometry::kLens;
using geometry::kParameters;
using geometry::kPosition;
using geometry::kRotation;
using geometry::kTimeOffset;

// Prior standard deviation of the camera's time offset [s].
constexpr double kOffsetStddev = 0.05;
// Standard deviation of the time offset of another camera whose offset is unknown [s].
constexpr double kUnknownOffset = 0.005;
// Limits of the result and of the wave, as in wave::solveWave().
constexpr double kMinimumInlierRatio = 0.5;
constexpr double kLargestNoise = 3.0;  // [px]
constexpr double kMinimumFlatness = 0.05;
constexpr double kMinimumExtent =
    0.1;  // Standard deviation of the path along its longest axis [m].
// Largest standard deviation of a predicted pixel due to the camera's uncertainty, the others being
// exact: RMS [px]. The camera's position alone says little: a longer lens further away sees the
// same.
constexpr double kLargestImageError = 2.0;
// Number of matches for which the derivatives by the others' parameters are computed.
constexpr std::size_t kDerivatives = 200;

std::string number(const char* format, double value) {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::size_t indexOf(const geometry::Rig& rig, const std::string& name) {
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    if (rig.cameras[i].camera.name == name)
      return i;
  }
  std::string names;
  for (const geometry::RigCamera& camera : rig.cameras)
    names += (names.empty() ? "" : ", ") + camera.camera.name;
  throw RecalibrateError("the rig has no camera '" + name + "': name one of " + names);
}

void checkInput(const geometry::Rig& rig, const Request& request, const Options& options) {
  rig.check();
  options.uncertainty.check();
  if (!(options.pixel > 0.0) || !(options.stamp >= 0.0) || !(options.maximum_offset_stddev > 0.0))
    throw RecalibrateError(
        "pixel and maximum_offset_stddev must be above 0, stamp at least 0: correct them");
  if (rig.ray_model != geometry::RayModel::kCalibrated)
    throw RecalibrateError(
        "the rig's rays are built through the image centre, which does not fit its cameras: "
        "calibrate all of it again");
  for (const capture::Image& image : request.images) {
    if (!std::isfinite(image.stamp))
      throw RecalibrateError("an image of " + image.camera + " has no time: correct its stamp");
  }
}

bool sameDevice(const geometry::RigCamera& calibrated, const Request& request) {
  const std::string& before = calibrated.camera.identity;
  return before.empty() || request.identity.empty() || before == request.identity;
}

/// Prior covariance of another device's lens.
ParameterMatrix lensCovariance(const geometry::Intrinsics& lens,
                               const square::Uncertainty& uncertainty) {
  ParameterMatrix covariance = ParameterMatrix::Zero();
  // fx = f sqrt(aspect), fy = f / sqrt(aspect).
  const double common = uncertainty.focal * uncertainty.focal;
  const double apart = 0.25 * uncertainty.aspect * uncertainty.aspect;
  covariance(kLens, kLens) = lens.fx * lens.fx * (common + apart);
  covariance(kLens + 1, kLens + 1) = lens.fy * lens.fy * (common + apart);
  covariance(kLens, kLens + 1) = covariance(kLens + 1, kLens) =
      lens.fx * lens.fy * (common - apart);
  covariance(kLens + 2, kLens + 2) = covariance(kLens + 3, kLens + 3) =
      uncertainty.principal_point * uncertainty.principal_point;
  covariance(kDistortion, kDistortion) = uncertainty.k1 * uncertainty.k1;
  return covariance;
}

/// The prior of the camera, and whether its lens is the rig's.
struct CameraPrior {
  Prior prior;
  bool lens_of_rig = false;
};

CameraPrior priorOf(const geometry::Rig& rig,
                    std::size_t index,
                    const Request& request,
                    const Options& options) {
  const geometry::RigCamera& calibrated = rig.cameras[index];
  CameraPrior known;
  const bool same = sameDevice(calibrated, request);
  known.prior.lens = same ? calibrated.camera.intrinsics : request.intrinsics;
  known.lens_of_rig = same && geometry::hasCovariance(rig);
  if (known.lens_of_rig) {
    const auto n = kTimeOffset - kLens;
    const Eigen::Index first = firstParameter(index) + kLens;
    known.prior.covariance.block(kLens, kLens, n, n) = rig.covariance.block(first, first, n, n);
  } else {
    known.prior.covariance = lensCovariance(known.prior.lens, options.uncertainty);
  }
  known.prior.covariance(kTimeOffset, kTimeOffset) = kOffsetStddev * kOffsetStddev;
  for (const capture::Image& image : request.images) {
    if (same && image.camera == request.camera) {
      // A start value; the offset is estimated again.
      known.prior.time_offset = timeOffset(calibrated, image.clock_epoch).value_or(0.0);
      break;
    }
  }
  return known;
}

void checkOthers(const geometry::Rig& rig, const SeenPath& path) {
  if (path.cameras().size() >= 2)
    return;
  const std::string seeing =
      path.cameras().empty() ? "none" : rig.cameras[path.cameras().front()].camera.name + " alone";
  throw RecalibrateError("of the other cameras " + seeing +
                         " saw the LED as its only moving light, but two are needed: wave where "
                         "they see it, and switch off other lights");
}

void checkFit(const Fit& fit) {
  const std::string& name = fit.camera.name;
  const auto found = fit.matches.size();
  if (fit.contradictory > found)
    throw RecalibrateError(
        "the other cameras contradict each other most of the time: they see different lights, or "
        "another one was moved; see that only the LED shines, or calibrate all of them again");
  if (static_cast<double>(found) < kMinimumInlierRatio * static_cast<double>(fit.expected))
    throw RecalibrateError(
        "only " + std::to_string(found) + " of " + std::to_string(fit.expected) + " images of " +
        name +
        " fit to what the others saw: it moved while the LED was waved, or sees another light; fix "
        "that and wave again");
  if (fit.pixel_stddev > kLargestNoise)
    throw RecalibrateError("the images of " + name + " are " + number("%.1f px", fit.pixel_stddev) +
                           " off what the others saw: its lens is not what it is taken for, or the "
                           "others were moved too; calibrate all of them again");

  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Match& match : fit.matches)
    mean += match.point.position / static_cast<double>(found);
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Match& match : fit.matches) {
    const Eigen::Vector3d d = match.point.position - mean;
    scatter += d * d.transpose() / static_cast<double>(found);
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(scatter);
  const Eigen::Vector3d extent = solver.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  if (extent[2] < kMinimumExtent)
    throw RecalibrateError("the LED moved by " + number("%.2f m", extent[2]) +
                           " only: wave it through the whole volume");
  if (extent[0] < kMinimumFlatness * extent[2])
    throw RecalibrateError(
        "the LED stayed on a line or in a plane: wave it through the whole volume, up and down "
        "and near and far");
}

/// Right-hand side of the camera's normal equations per error of each parameter of the rig: inverse
/// of the information times this is how the camera's estimate changes with them.
Eigen::MatrixXd sensitivityToRig(const geometry::Rig& rig,
                                 std::size_t index,
                                 const CameraPrior& known,
                                 const Options& options,
                                 const Fit& fit) {
  const Eigen::Index size = firstParameter(rig.cameras.size());
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(kParameters, size);
  const std::size_t stride = std::max<std::size_t>(1, fit.matches.size() / kDerivatives);
  double used = 0.0;
  for (std::size_t i = 0; i < fit.matches.size(); i += stride) {
    const Match& match = fit.matches[i];
    const auto own = linearize(fit.camera, match, fit.pixel_stddev, options.stamp);
    if (!own)
      continue;
    const auto point_by_parameters = geometry::pointByParameters(
        rig, match.point.position, match.point.cameras, match.point.velocity);
    if (!point_by_parameters)
      continue;
    // The prediction moves with the point.
    right -= own->jacobian.transpose() * own->covariance.inverse() * own->by_point *
             *point_by_parameters;
    used += 1.0;
  }
  right *= static_cast<double>(fit.matches.size()) / used;
  if (known.lens_of_rig) {
    // The prior mean of the lens is a parameter of the rig, too.
    ParameterMatrix lens = fit.prior_information;
    lens.col(kTimeOffset).setZero();
    right.middleCols<kParameters>(firstParameter(index)) += lens;
  }
  return right;
}

/// Inverse over the free parameters; zero elsewhere.
ParameterMatrix inverseOf(const ParameterMatrix& information,
                          const std::vector<Eigen::Index>& free) {
  const auto n = static_cast<Eigen::Index>(free.size());
  Eigen::MatrixXd part(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j)
      part(i, j) =
          information(free[static_cast<std::size_t>(i)], free[static_cast<std::size_t>(j)]);
  }
  const Eigen::MatrixXd inverse = part.ldlt().solve(Eigen::MatrixXd::Identity(n, n));
  ParameterMatrix result = ParameterMatrix::Zero();
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j)
      result(free[static_cast<std::size_t>(i)], free[static_cast<std::size_t>(j)]) =
          0.5 * (inverse(i, j) + inverse(j, i));
  }
  return result;
}

/// Variance of the mean of the stamps' errors over the wave, which are correlated over seconds
/// [s^2].
double meanStampVariance(const Fit& fit, const Options& options) {
  const double kCorrelationTime = 2.0;  // [s]
  return options.stamp * options.stamp * std::min(1.0, 2.0 * kCorrelationTime / fit.duration);
}

/// Writes the camera's block and its cross covariances into the rig's covariance.
/// @returns the camera's block.
ParameterMatrix updateCovariance(const SeenPath& path,
                                 std::size_t index,
                                 const CameraPrior& known,
                                 const Options& options,
                                 const Fit& fit,
                                 geometry::Rig* rig) {
  const ParameterMatrix inverse = inverseOf(fit.information, fit.free);
  ParameterMatrix noise = fit.information;
  if (known.lens_of_rig) {
    // The rig's covariance contributes the prior below.
    ParameterMatrix lens = fit.prior_information;
    lens.row(kTimeOffset).setZero();
    lens.col(kTimeOffset).setZero();
    noise -= lens;
  }
  ParameterMatrix own = inverse * noise * inverse;
  own(kTimeOffset, kTimeOffset) += meanStampVariance(fit, options);
  if (!geometry::hasCovariance(*rig))
    return own;
  const Eigen::MatrixXd by_rig = inverse * sensitivityToRig(*rig, index, known, options, fit);
  Eigen::MatrixXd others = rig->covariance;
  for (const std::size_t i : path.cameras()) {
    if (!path.clockKnown(i)) {
      const Eigen::Index k = firstParameter(i) + kTimeOffset;
      others(k, k) += kUnknownOffset * kUnknownOffset;
    }
  }
  own += by_rig * others * by_rig.transpose();
  own = 0.5 * (own + own.transpose()).eval();
  const Eigen::MatrixXd common = by_rig * rig->covariance;
  const Eigen::Index first = firstParameter(index);
  rig->covariance.middleRows<kParameters>(first) = common;
  rig->covariance.middleCols<kParameters>(first) = common.transpose();
  rig->covariance.block<kParameters, kParameters>(first, first) = own;
  return own;
}

/// RMS standard deviation of the predicted pixels due to the camera's uncertainty, the others being
/// exact [px].
double imageError(const Fit& fit) {
  const ParameterMatrix covariance = inverseOf(fit.information, fit.free);
  double squared = 0.0;
  for (const Match& match : fit.matches) {
    if (const auto linear = linearize(fit.camera, match, fit.pixel_stddev, 0.0))
      squared += (linear->jacobian * covariance * linear->jacobian.transpose()).trace();
  }
  return std::sqrt(squared / static_cast<double>(fit.matches.size()));
}

void checkCertainty(const Fit& fit, const Recalibration& result, const Options& options) {
  const std::string& name = fit.camera.name;
  if (result.offset_stddev > options.maximum_offset_stddev)
    throw RecalibrateError("the time offset of " + name + " would be known to " +
                           number("%.2f ms", 1000.0 * result.offset_stddev) + " only, but " +
                           number("%.2f ms", 1000.0 * options.maximum_offset_stddev) +
                           " are needed: wave longer and faster");
  const double error = imageError(fit);
  if (error > kLargestImageError)
    throw RecalibrateError("where " + name + " sees a point would be known to " +
                           number("%.1f px", error) +
                           " only: wave longer, through the whole volume that it sees");
}

/// The camera as it is now.
geometry::RigCamera rigCamera(const geometry::RigCamera& before,
                              const Request& request,
                              const Fit& fit) {
  geometry::RigCamera camera = before;
  camera.camera = fit.camera;
  if (!request.identity.empty())
    camera.camera.identity = request.identity;
  camera.gravity = request.gravity;
  camera.time_offset = fit.time_offset;
  camera.time_offset_rule = geometry::TimeOffsetRule::kOneEpoch;
  for (const capture::Image& image : request.images) {
    if (image.camera == request.camera)
      camera.time_offset_epoch = image.clock_epoch;
  }
  camera.observations = static_cast<std::uint32_t>(fit.expected);
  camera.inliers = static_cast<std::uint32_t>(fit.matches.size());
  double squared_px = 0.0;
  double squared_m = 0.0;
  for (const Match& match : fit.matches) {
    const auto pixel = fit.camera.project(match.point.position);
    if (!pixel)
      continue;
    const double squared = (*pixel - match.pixel).squaredNorm();
    const geometry::Intrinsics& lens = fit.camera.intrinsics;
    squared_px += squared;
    squared_m +=
        squared * (match.point.position - fit.camera.center()).squaredNorm() / (lens.fx * lens.fy);
  }
  camera.residual_px = std::sqrt(squared_px / camera.inliers);
  camera.residual_m = std::sqrt(squared_m / camera.inliers);
  return camera;
}

}  // namespace

Recalibration recalibrateCamera(const geometry::Rig& rig,
                                const Request& request,
                                const Options& options) {
  const std::size_t index = indexOf(rig, request.camera);
  checkInput(rig, request, options);
  const SeenPath path(rig, request.images, request.camera);
  checkOthers(rig, path);
  const CameraPrior known = priorOf(rig, index, request, options);
  geometry::Camera start = rig.cameras[index].camera;
  start.intrinsics = known.prior.lens;
  const Fit fit = resect(path, movingLights(request.images, request.camera), start, known.prior,
                         {options.pixel, options.stamp});
  checkFit(fit);

  Recalibration result;
  result.rig = rig;
  const ParameterMatrix covariance =
      updateCovariance(path, index, known, options, fit, &result.rig);
  result.rotation_stddev = std::sqrt(covariance.diagonal().segment<3>(kRotation).sum());
  result.position_stddev = std::sqrt(covariance.diagonal().segment<3>(kPosition).sum());
  result.offset_stddev = std::sqrt(covariance(kTimeOffset, kTimeOffset));
  checkCertainty(fit, result, options);
  result.rig.cameras[index] = rigCamera(rig.cameras[index], request, fit);
  const Eigen::Isometry3d& before = rig.cameras[index].camera.world_from_camera;
  const Eigen::Isometry3d& now = fit.camera.world_from_camera;
  result.moved = (now.translation() - before.translation()).norm();
  result.turned = Eigen::AngleAxisd(before.linear().transpose() * now.linear()).angle();
  result.images = fit.matches.size();
  result.message = request.camera + " moved by " + number("%.1f mm", 1000.0 * result.moved) +
                   " and turned by " + number("%.2f degrees", result.turned * 180.0 / M_PI) +
                   "; it is known to " + number("%.1f mm", 1000.0 * result.position_stddev) +
                   " and " + number("%.2f degrees", result.rotation_stddev * 180.0 / M_PI) +
                   " again, from " + std::to_string(result.images) +
                   " images; check a known place, then save the rig";
  const std::string how = "+recalibrated " + request.camera;
  if (result.rig.method.find(how) == std::string::npos)
    result.rig.method += how;
  result.rig.verdict += (rig.verdict.empty() ? "" : "; ") + result.message;
  result.rig.check();
  return result;
}

}  // namespace wiimote_tracker::recalibrate
